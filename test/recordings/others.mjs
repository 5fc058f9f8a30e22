// SPDX-License-Identifier: BSD-3-Clause
// others.mjs write FOLDER: recordings of the same five clouds, in chunks without compression, by lz4 and zstd, and
// without chunks. Each cloud is an unorganized PointCloud2 in firing order with fields in an unusual order.
// others.mjs read FILE: prints the clusters in a recording of results: id, size, ground returns of the cloud, oriented
// box; and a line for each cloud.
import fs from 'node:fs';
import {McapWriter, McapIndexedReader} from '@mcap/core';
import {parse} from '@foxglove/rosmsg';
import {MessageReader, MessageWriter} from '@foxglove/rosmsg2-serialization';
import lz4 from 'lz4js';
import zstdCodec from 'zstd-codec';

const zstd = await new Promise((done) => zstdCodec.ZstdCodec.run((codec) => done(new codec.Simple())));
const bar = '='.repeat(80);
const schemas = {
  'sensor_msgs/msg/PointCloud2': `std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
${bar}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
${bar}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
${bar}
MSG: sensor_msgs/PointField
uint8 FLOAT32=7
string name
uint32 offset
uint8 datatype
uint32 count
`,
  'std_msgs/msg/String': 'string data\n',
};

class FileOut {
  constructor(path) { this.fd = fs.openSync(path, 'w'); this.at = 0n; }
  async write(bytes) { fs.writeSync(this.fd, bytes); this.at += BigInt(bytes.byteLength); }
  position() { return this.at; }
}

/// Two walls of 4 lasers and 30 firings each, firing by firing.
function cloud(index) {
  const step = 24;
  const data = Buffer.alloc(step * 240);
  for (let i = 0; i < 240; ++i) {
    const firing = Math.floor(i / 4), ring = i % 4;
    const azimuth = (firing < 30 ? 0 : Math.PI) + 0.02 * (firing % 30) + 0.001 * index;
    data.writeUInt16LE(ring, i * step);
    data.writeDoubleLE(100 * index + firing * 1e-3 + ring * 1e-6, i * step + 2);
    data.writeFloatLE(0.1 * ring, i * step + 10);
    data.writeFloatLE(10 * Math.sin(azimuth), i * step + 14);
    data.writeFloatLE(10 * Math.cos(azimuth), i * step + 18);
  }
  const field = (name, offset, datatype) => ({name, offset, datatype, count: 1});
  return {
    header: {stamp: {sec: 1700000000 + index, nanosec: 5}, frame_id: 'lidar_link'},
    height: 1, width: 240,
    fields: [field('ring', 0, 4), field('timestamp', 2, 8), field('z', 10, 7), field('y', 14, 7), field('x', 18, 7)],
    is_bigendian: false, point_step: step, row_step: step * 240, data: new Uint8Array(data), is_dense: true,
  };
}

async function write(path, options) {
  const writer = new McapWriter({writable: new FileOut(path), ...options});
  await writer.start({profile: 'ros2', library: 'test'});
  const channels = {};
  const writers = {};
  for (const [topic, type] of [['/points', 'sensor_msgs/msg/PointCloud2'], ['/rear', 'sensor_msgs/msg/PointCloud2'],
                               ['/name', 'std_msgs/msg/String']]) {
    const schemaId = await writer.registerSchema(
        {name: type, encoding: 'ros2msg', data: new TextEncoder().encode(schemas[type])});
    channels[topic] =
        await writer.registerChannel({schemaId, topic, messageEncoding: 'cdr', metadata: new Map([['qos', '']])});
    writers[topic] = new MessageWriter(parse(schemas[type], {ros2: true}));
  }
  for (let i = 0; i < 5; ++i)
    for (const topic of ['/name', '/points', '/rear']) {
      const time = 1700000000000000000n + 100000000n * BigInt(i);
      const data = writers[topic].writeMessage(topic === '/name' ? {data: 'number ' + i} : cloud(i));
      await writer.addMessage({channelId: channels[topic], sequence: i, logTime: time, publishTime: time, data});
    }
  await writer.end();
}

async function read(path) {
  const file = fs.readFileSync(path);
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(file.length),
      read: async (offset, size) => new Uint8Array(file.subarray(Number(offset), Number(offset + size))),
    },
    decompressHandlers: {zstd: (bytes) => zstd.decompress(bytes), lz4: (bytes) => lz4.decompress(bytes)},
  });
  const readers = new Map();
  const points = new Map();
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    if (!readers.has(schema.id))
      readers.set(schema.id, new MessageReader(parse(new TextDecoder().decode(schema.data), {ros2: true})));
    const value = readers.get(schema.id).readMessage(message.data);
    if (schema.name === 'sensor_msgs/msg/PointCloud2') {
      const sizes = new Map();
      const view = new DataView(value.data.buffer, value.data.byteOffset, value.data.byteLength);
      const at = value.fields.find((field) => field.name === 'label').offset;
      const groundAt = value.fields.find((field) => field.name === 'ground').offset;
      let ground = 0;
      for (let i = 0; i < value.width * value.height; ++i) {
        ground += view.getUint8(i * value.point_step + groundAt);
        const label = view.getUint32(i * value.point_step + at, true);
        sizes.set(label, (sizes.get(label) ?? 0) + 1);
      }
      points.set(message.logTime, {sizes, ground});
      console.log(`# ${schema.name} ${value.header.frame_id} ${value.width * value.height} points`);
    } else {
      if (schema.name !== 'visualization_msgs/msg/MarkerArray') throw new Error(schema.name);
      if (value.markers[0].action !== 3) throw new Error('the markers of the last scan are not deleted');
      for (const marker of value.markers.slice(1)) {
        const {position, orientation} = marker.pose;
        if (marker.type !== 1 || marker.action !== 0 || orientation.x !== 0 || orientation.y !== 0 ||
            Math.abs(Math.hypot(orientation.z, orientation.w) - 1) > 1e-9 || !(marker.color.a > 0))
          throw new Error('a marker that is no upright box');
        const {sizes, ground} = points.get(message.logTime);
        const box = [...['x', 'y', 'z'].map((axis) => position[axis]),
                     360 / Math.PI * Math.atan2(orientation.z, orientation.w),
                     ...['x', 'y', 'z'].map((axis) => marker.scale[axis])];
        console.log([marker.id, sizes.get(marker.id), ground, ...box.map((value) => value.toFixed(4))].join(' '));
      }
    }
  }
}

const [what, path] = process.argv.slice(2);
if (what === 'write') {
  await write(path + '/none.mcap', {});
  await write(path + '/unchunked.mcap', {useChunks: false});
  await write(path + '/lz4.mcap',
              {compressChunk: (data) => ({compression: 'lz4', compressedData: lz4.compress(data)})});
  await write(path + '/zstd.mcap',
              {compressChunk: (data) => ({compression: 'zstd', compressedData: zstd.compress(data)})});
} else {
  await read(path);
}
