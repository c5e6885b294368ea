#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>

namespace lacuna {

/// The free space of a disk.
struct DiskRoom {
  std::uint64_t bytes = 0;
  std::uint64_t inodes = 0;
  std::uint64_t all_inodes = 0;  ///< 0: the file system creates them as needed
};

/// The free space on the disk of `folder`, compared with a floor below which no job starts.
class DiskWatch {
 public:
  /// `floor`: bytes; 0: no floor, for inodes neither.
  DiskWatch(std::filesystem::path folder, std::uint64_t floor)
      : folder_(std::move(folder)), floor_(floor) {}

  /// The free space now. Throws std::system_error.
  DiskRoom room() const;
  std::uint64_t floor() const { return floor_; }
  /// Checks the free space. Once it was below the floor, it stays low until a tenth above the floor
  /// (hysteresis), so that a few checkpoints do not stop all work again. If the disk does not
  /// answer, the last result is kept.
  bool is_low();
  /// The shortage at the last check; empty: none.
  std::string shortage() const;

 private:
  const std::filesystem::path folder_;
  const std::uint64_t floor_;
  mutable std::mutex mutex_;  // guards all below
  std::string shortage_;
};

/// The shortage of `room` if `floor` bytes and, where inodes are limited, 1024 of them or a
/// sixteenth of all must stay free; `was_low` raises both by a tenth. Empty: none.
std::string shortage_of(const DiskRoom& room, std::uint64_t floor, bool was_low);

}  // namespace lacuna
