// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/capture_file.h"

#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <boost/endian/conversion.hpp>

#include "io/text.h"
#include "io/time_limits.h"

namespace lisco_apps {
namespace {

/// The rest of a frame, in network byte order.
struct FrameRest {
  const std::uint8_t* data;
  std::size_t size;

  unsigned u8(std::size_t at) const { return data[at]; }
  unsigned u16(std::size_t at) const { return boost::endian::load_big_u16(data + at); }
  /// Drops the first bytes. \return false if there are fewer
  bool skip(std::size_t count) {
    if (count > size) return false;
    data += count;
    size -= count;
    return true;
  }
};

constexpr unsigned kIpv4 = 0x0800, kIpv6 = 0x86DD, kUdp = 17;
constexpr std::array<unsigned, 3> kVlanTags{0x8100, 0x88A8, 0x9100};

/// Skips a link header and VLAN tags after it. \return false if their EtherType is not IP
bool skipLink(FrameRest& frame, std::size_t type_at, std::size_t header) {
  if (frame.size < header) return false;
  unsigned type = frame.u16(type_at);
  frame.skip(header);
  while (std::find(kVlanTags.begin(), kVlanTags.end(), type) != kVlanTags.end()) {
    if (frame.size < 4) return false;
    type = frame.u16(2);
    frame.skip(4);
  }
  return type == kIpv4 || type == kIpv6;
}

void setKey(Fragment& fragment, const std::uint8_t* addresses, std::size_t size, const std::uint8_t* identification,
            std::size_t identification_size) {
  std::copy_n(addresses, size, fragment.key.begin());
  std::copy_n(identification, identification_size, fragment.key.begin() + 32);
}

bool skipIpv4(FrameRest& packet, std::optional<Fragment>& part) {
  if (packet.size < 20) return false;
  const std::size_t header = 4UL * (packet.u8(0) & 0xFU);
  const unsigned position = packet.u16(6);  // flags and offset
  if (header < 20 || packet.u8(9) != kUdp) return false;
  if ((position & 0x3FFFU) != 0) {
    part.emplace();
    setKey(*part, packet.data + 12, 8, packet.data + 4, 2);
    part->offset = 8UL * (position & 0x1FFFU);
    part->is_last = (position & 0x2000U) == 0;
    // A fragment's length is not checked by UDP's.
    if (packet.size < packet.u16(2)) return false;
  }
  // Position packets of the VLP-16 declare a longer total than they have; the UDP length is checked instead.
  packet.size = std::min<std::size_t>(packet.size, packet.u16(2));
  return packet.skip(header);
}

bool skipIpv6(FrameRest& packet, std::optional<Fragment>& part) {
  if (packet.size < 40) return false;
  const std::size_t length = packet.u16(4);
  const std::uint8_t* const addresses = packet.data + 8;
  unsigned next = packet.u8(6);
  packet.skip(40);
  const bool is_whole = packet.size >= length;
  packet.size = std::min(packet.size, length);
  constexpr unsigned kHopByHop = 0, kRouting = 43, kFragment = 44, kOptions = 60;
  while (next == kHopByHop || next == kRouting || next == kFragment || next == kOptions) {
    if (packet.size < 8) return false;
    const bool is_part = next == kFragment;
    next = packet.u8(0);
    const unsigned position = packet.u16(2);  // offset and flags
    if (is_part && (position & 0xFFF9U) != 0) {
      part.emplace();
      setKey(*part, addresses, 32, packet.data + 4, 4);
      part->offset = position & 0xFFF8U;
      part->is_last = (position & 1U) == 0;
      return next == kUdp && is_whole && packet.skip(8);
    }
    if (!packet.skip(is_part ? 8 : 8 * (packet.u8(1) + 1UL))) return false;
  }
  return next == kUdp;
}

bool isKnown(int link_type) {
  return link_type == DLT_EN10MB || link_type == DLT_LINUX_SLL || link_type == DLT_LINUX_SLL2 || link_type == DLT_RAW ||
         link_type == DLT_IPV4 || link_type == DLT_IPV6 || link_type == DLT_NULL || link_type == DLT_LOOP;
}

bool skipToIp(FrameRest& frame, int link_type) {
  if (link_type == DLT_EN10MB) return skipLink(frame, 12, 14);
  if (link_type == DLT_LINUX_SLL) return skipLink(frame, 14, 16);
  if (link_type == DLT_LINUX_SLL2) return skipLink(frame, 0, 20);
  const bool has_family = link_type == DLT_NULL || link_type == DLT_LOOP;
  return !has_family || frame.skip(4);
}

/// Reduces a frame to the content of its IP packet, of which it may be a part. \return false if it holds no UDP
bool skipToUdp(FrameRest& frame, int link_type, std::optional<Fragment>& part) {
  if (!skipToIp(frame, link_type) || frame.size == 0) return false;
  const unsigned version = frame.u8(0) >> 4U;
  return version == 4 ? skipIpv4(frame, part) : version == 6 && skipIpv6(frame, part);
}

/// \return false if it is no whole UDP packet to this port
bool skipToPayload(FrameRest& frame, std::optional<std::uint16_t> port) {
  if (frame.size < 8 || (port && frame.u16(2) != *port)) return false;
  const std::size_t length = frame.u16(4);
  if (length > frame.size) return false;
  frame.size = length;
  return frame.skip(8);
}

}  // namespace

void CaptureFile::Close::operator()(pcap* capture) const {
  pcap_close(capture);
}

CaptureFile::CaptureFile(const fs::path& file, std::optional<std::uint16_t> port) : file_(file), port_(port) {
  std::error_code unknown;
  if (fs::is_directory(file, unknown)) fail(file, "is no capture of packets: it is a folder");
  if (fs::is_regular_file(file, unknown) && fs::file_size(file, unknown) == 0)
    fail(file, "is no capture of packets: it is empty");
  // Opened as a stream, as libpcap takes a file named "-" for the standard input.
  std::FILE* const stream = std::fopen(file.c_str(), "rb");
  if (stream == nullptr) fail(file, std::strerror(errno));
  std::array<char, PCAP_ERRBUF_SIZE> why{};
  capture_.reset(pcap_fopen_offline(stream, why.data()));
  if (!capture_) {
    std::fclose(stream);
    fail(file, std::string("is no capture of packets: ") + why.data());
  }
  link_type_ = pcap_datalink(capture_.get());
  if (!isKnown(link_type_)) {
    const char* const name = pcap_datalink_val_to_name(link_type_);
    fail(file, "is a capture of another kind of network: " + (name ? name : std::to_string(link_type_)));
  }
}

double CaptureFile::share() const {
  std::error_code unknown;
  const std::uintmax_t size = fs::is_regular_file(file_, unknown) ? fs::file_size(file_, unknown) : 0;
  const long at = std::ftell(pcap_file(capture_.get()));
  return size == 0 || at < 0 ? 0 : static_cast<double>(at) / static_cast<double>(size);
}

PacketSource::Arrival CaptureFile::next(Packet& packet) {
  pcap_pkthdr* header = nullptr;
  const u_char* data = nullptr;
  const auto read = [&] {
    errno = 0;
    return pcap_next_ex(capture_.get(), &header, &data) == 1;
  };
  while (error_.empty() && read()) {
    constexpr std::int64_t kMaxSeconds = kMaxTimeNs / 1000000000;
    const std::int64_t time_us =
        1000000 * std::clamp<std::int64_t>(header->ts.tv_sec, -kMaxSeconds, kMaxSeconds) + header->ts.tv_usec;
    FrameRest payload{data, header->caplen};
    std::optional<Fragment> part;
    const bool is_udp = skipToUdp(payload, link_type_, part);
    if (is_udp && part) {
      part->content = {reinterpret_cast<const char*>(payload.data), payload.size};
      part->time_us = time_us;
      const std::string_view whole = fragments_.add(*part);
      foreign_ = foreign_frames_ + fragments_.lost();
      if (whole.empty()) continue;
      payload = {reinterpret_cast<const std::uint8_t*>(whole.data()), whole.size()};
    }
    if (!is_udp || !skipToPayload(payload, port_)) {
      foreign_ = ++foreign_frames_ + fragments_.lost();
      continue;
    }
    ++packets_;
    packet = {payload.data, payload.size, time_us};
    return Arrival::kPacket;
  }
  fragments_.clear();
  foreign_ = foreign_frames_ + fragments_.lost();
  // A signal that ends the program may interrupt the reading of a pipe.
  if (const char* const why = pcap_geterr(capture_.get()); error_.empty() && *why != '\0' && errno != EINTR)
    error_ = file_.string() + ": breaks off: " + why;
  return Arrival::kEnd;
}

}  // namespace lisco_apps
