#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace lacuna {

/// One error in a document. `pointer`: its position, a JSON pointer (RFC 6901); `message`: what was
/// found and what is allowed.
struct Problem {
  std::string pointer;
  std::string message;
  bool operator==(const Problem&) const = default;
};

/// A document with problems, as many as could be found at once. Exit code 2; HTTP 400.
class BadJob : public std::runtime_error {
 public:
  explicit BadJob(std::vector<Problem> problems);
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace lacuna
