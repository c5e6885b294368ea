#include "base/storage/input_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <functional>
#include <stdexcept>
#include <vector>

#include "base/storage/passing_error.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;

/// Leaves this process without a descriptor for as long as it lives.
class NoDescriptors {
 public:
  NoDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &limit_);
    const rlimit none{0, limit_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  NoDescriptors(const NoDescriptors&) = delete;
  NoDescriptors& operator=(const NoDescriptors&) = delete;
  ~NoDescriptors() { ::setrlimit(RLIMIT_NOFILE, &limit_); }

 private:
  rlimit limit_{};
};

TEST(InputFile, ItsHashIsThatOfItsContentAlone) {
  const TemporaryFolder folder;
  const auto a = folder.write("a", std::string(3 << 20, 'x') + "1");
  const auto b = folder.write("b", std::string(3 << 20, 'x') + "2");
  InputFile read;
  EXPECT_EQ(read_input(a, 4 << 20, read).size(), (3U << 20) + 1);
  fs::last_write_time(a, fs::last_write_time(a) - std::chrono::hours(1));
  const InputFile measured = measure_input(a);
  EXPECT_EQ(measured, read);
  EXPECT_EQ(measured.hash.size(), 16U);
  EXPECT_EQ(measure_input(b).bytes, read.bytes);
  EXPECT_NE(measure_input(b).hash, read.hash);
  EXPECT_EQ(measure_input(b, 7).hash, "") << "of another size it is not read";
}

TEST(InputFile, AFaultThatMayPassIsTold) {
  const TemporaryFolder folder;
  const auto file = folder.write("a", "content");
  for (const int error : {EIO, EMFILE, ENFILE, ESTALE, EACCES, ETIMEDOUT, ENOTCONN, ENOMEM}) {
    EXPECT_THROW(throw_if_it_may_pass(error, file, folder.path()), InputUnreadable) << error;
  }
  for (const int error : {0, ENOENT, ENOTDIR, EISDIR, ELOOP, ENAMETOOLONG, EINVAL}) {
    EXPECT_NO_THROW(throw_if_it_may_pass(error, file, folder.path())) << error;
  }
  InputFile about;
  const NoDescriptors none;
  EXPECT_THROW(read_input(file, 100, about), InputUnreadable);
  EXPECT_THROW(measure_input(file), InputUnreadable);
}

TEST(InputFile, WithoutPermissionItMayBeReadAnotherTime) {
  const TemporaryFolder folder;
  const auto file = folder.write("a", "content");
  fs::permissions(file, fs::perms::none);
  fs::permissions(folder.path(), fs::perms::all);
  constexpr uid_t nobody = 65534;
  const bool root = ::geteuid() == 0;  // may read everything
  ASSERT_EQ(root ? ::seteuid(nobody) : 0, 0);
  EXPECT_THROW(measure_input(file), InputUnreadable);
  ASSERT_EQ(root ? ::seteuid(0) : 0, 0);
}

TEST(InputFile, WhatIsMissingBesideOthersIsWrongAndWhereNothingIsAway) {
  const TemporaryFolder folder;
  const auto share = folder / "share";
  const auto look = [&](const char* name) { throw_if_it_may_pass(ENOENT, share / name, share); };
  EXPECT_THROW(look("a"), InputUnreadable);
  fs::create_directories(share);
  EXPECT_THROW(look("a"), InputUnreadable);
  EXPECT_THROW(look("sub/a"), InputUnreadable);
  EXPECT_THROW(measure_input(share / "a"), InputUnreadable);
  fs::create_directories(share / "sub");
  EXPECT_NO_THROW(look("a"));
  EXPECT_NO_THROW(look("sub/a")) << "the share is there";
  EXPECT_TRUE(contains(message_of<std::invalid_argument>([&] { measure_input(share / "a"); }),
                       "cannot be opened: No such file"));
}

TEST(InputFile, WhatIsNoFileOrTooLargeIsWrong) {
  const TemporaryFolder folder;
  InputFile about;
  EXPECT_TRUE(
      contains(message_of<std::invalid_argument>([&] { read_input(folder.path(), 100, about); }),
               "is not a regular file"));
  const auto file = folder.write("a", "content");
  EXPECT_TRUE(
      contains(message_of<std::length_error>([&] { read_input(file, 6, about); }), "has 7 bytes"));
}

}  // namespace
}  // namespace lacuna
