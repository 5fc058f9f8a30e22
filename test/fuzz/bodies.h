// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Checks of any bytes, for a fuzzer or a test. Each body throws a Finding if something does not hold.
//
//   cmake -S . -B build/fuzz -DCMAKE_CXX_COMPILER=clang++ -DLISCO_BUILD_FUZZERS=ON && cmake --build build/fuzz
//   build/fuzz/test/fuzz/lisco_fuzz_engine new_inputs test/fuzz/corpus/engine
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace lisco_test {

/// A violated property.
struct Finding : std::logic_error {
  using std::logic_error::logic_error;
};

/// \throws Finding if it does not hold
inline void hold(bool what_must_be, const char* what) {
  if (!what_must_be) throw Finding(what);
}

/// A scan, its setting and its portions, against the oracle; sliding windows and endless streams as well.
void fuzzEngine(const std::uint8_t* data, std::size_t size);

/// Calls of the clusterers in any order, wrong ones too.
void fuzzStream(const std::uint8_t* data, std::size_t size);

/// The ground of a scan: the whole equals column by column, and none of it is no return.
void fuzzGround(const std::uint8_t* data, std::size_t size);

/// A scan's file, whose first byte gives the format.
void fuzzReaders(const std::uint8_t* data, std::size_t size);

/// A recording, one of its messages, or a cloud of floats; the first byte gives the kind.
void fuzzRecordings(const std::uint8_t* data, std::size_t size);

/// Packets of a Velodyne sensor, or a capture of them.
void fuzzPackets(const std::uint8_t* data, std::size_t size);

/// Packets of a Hesai sensor.
void fuzzHesai(const std::uint8_t* data, std::size_t size);

/// Packets of an Ouster sensor, or its metadata.
void fuzzOuster(const std::uint8_t* data, std::size_t size);

/// Requests to the server of the live view, what its viewers send, and its addresses.
void fuzzHttp(const std::uint8_t* data, std::size_t size);

}  // namespace lisco_test
