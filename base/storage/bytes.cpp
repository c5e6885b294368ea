#include "base/storage/bytes.h"

#include <algorithm>

namespace lacuna {

void ByteWriter::flush() {
  if (!sink_ || bytes_.empty()) return;
  sink_(bytes_);
  bytes_.clear();
}

void ByteWriter::hand_on(std::string_view more) {
  flush();
  for (; more.size() > piece_bytes; more.remove_prefix(piece_bytes)) {
    sink_(more.substr(0, piece_bytes));
  }
  bytes_.append(more);
}

void ByteReader::read_on(char* to, std::size_t n) {
  if (n > remaining()) throw std::runtime_error("saved state ends early");
  to = std::copy(bytes_.begin(), bytes_.end(), to);
  n -= bytes_.size();
  bytes_ = {};
  for (; n >= piece_bytes; to += piece_bytes, n -= piece_bytes, ahead_ -= piece_bytes) {
    source_(to, piece_bytes);
  }
  if (n == 0) return;
  buffer_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, ahead_)));
  source_(buffer_.data(), buffer_.size());
  ahead_ -= buffer_.size();
  bytes_ = buffer_;
  read(to, n);
}

}  // namespace lacuna
