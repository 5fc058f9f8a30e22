# SPDX-License-Identifier: BSD-3-Clause
# rosbag_writer.py FOLDER: ROS 1 bags written by ROS's own library (Debian's python3-rosbag, python3-sensor-msgs): five
# clouds of two walls, 4 lasers and 60 firings, in chunks without compression, by bz2 and by lz4.
import math
import struct
import sys

import rosbag
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from std_msgs.msg import String

for compression in ('none', 'bz2', 'lz4'):
    bag = rosbag.Bag(f'{sys.argv[1]}/{compression}.bag', 'w', compression=compression, chunk_threshold=20000)
    for i in range(5):
        cloud = PointCloud2(height=1, width=240, point_step=18, row_step=18 * 240)
        cloud.header.frame_id = 'lidar_link'
        cloud.header.stamp = rospy.Time(1600000000 + i, 5)
        cloud.fields = [PointField(*field, 1)
                        for field in (('x', 0, 7), ('y', 4, 7), ('z', 8, 7), ('ring', 12, 4), ('time', 14, 7))]
        data = b""
        for firing in range(60):
            azimuth = (0 if firing < 30 else 3.1) + 0.02 * (firing % 30)
            for ring in range(4):
                data += struct.pack('<fffHf', 10 * math.cos(azimuth), 10 * math.sin(azimuth), 0.1 * ring, ring,
                                          firing * 1e-3)
        cloud.data = data
        bag.write('/points', cloud, rospy.Time(1600000000 + i, 0))
        bag.write('/name', String('a cloud'), rospy.Time(1600000000 + i, 1))
    bag.close()
