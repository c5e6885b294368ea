#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>

namespace lacuna {

/// The room on the disk where `folder` lies, against a floor below which nothing shall start.
class DiskWatch {
 public:
  /// `floor`: bytes; 0: any room is enough.
  DiskWatch(std::filesystem::path folder, std::uint64_t floor)
      : folder_(std::move(folder)), floor_(floor) {}

  /// Bytes that may still be written. Throws std::system_error.
  std::uint64_t free_bytes() const;
  std::uint64_t floor() const { return floor_; }
  /// Looks anew. Once there was too little room, there has to be a tenth more than the floor before
  /// there is enough: or a few checkpoints would stop all work again. A disk that does not answer
  /// counts as it was before.
  bool is_low();

 private:
  const std::filesystem::path folder_;
  const std::uint64_t floor_;
  std::mutex mutex_;
  bool low_ = false;
};

}  // namespace lacuna
