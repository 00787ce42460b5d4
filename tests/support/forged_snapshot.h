/* Snapshots whose checksum and length were made to fit, so that what lies behind them is reached. Needs the library's insides. */
#pragma once

#include <cstring>

#include "scene/snapshot_format.h"
#include "support/snapshots.h"

namespace loam::snapshots {

inline void forge(Bytes &bytes) {
  if (bytes.size() < sizeof(SnapshotHeader)) return;
  SnapshotHeader header;
  std::memcpy(&header, bytes.data(), sizeof header);
  header.bytes = bytes.size();
  std::memcpy(bytes.data(), &header, sizeof header);
  header.checksum = snapshot_checksum(bytes.data(), bytes.size());
  std::memcpy(bytes.data(), &header, sizeof header);
}

} // namespace loam::snapshots
