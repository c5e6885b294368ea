#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>

namespace lacuna {

/// The free space on the disk of `folder`, compared with a floor below which no job starts.
class DiskWatch {
 public:
  /// `floor`: bytes; 0: any room is enough.
  DiskWatch(std::filesystem::path folder, std::uint64_t floor)
      : folder_(std::move(folder)), floor_(floor) {}

  /// Bytes that may still be written. Throws std::system_error.
  std::uint64_t free_bytes() const;
  std::uint64_t floor() const { return floor_; }
  /// Checks the free space. Once it was below the floor, it stays low until a tenth above the floor
  /// (hysteresis), so that a few checkpoints do not stop all work again. If the disk does not
  /// answer, the last result is kept.
  bool is_low();

 private:
  const std::filesystem::path folder_;
  const std::uint64_t floor_;
  std::mutex mutex_;
  bool low_ = false;
};

}  // namespace lacuna
