#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <system_error>
#include <thread>

#include "base/storage/atomic_file.h"
#include "base/storage/file_handle.h"
#include "tests/child_process.h"
#include "tests/failing_files.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Names = std::set<std::string>;

TEST(AtomicFile, ReplacesTheWholeContent) {
  const TemporaryFolder tmp;
  for (const bool sync : {true, false}) {
    for (const std::string& content :
         {std::string("first"), std::string(), std::string(3 << 20, 'x'), std::string("a\0b", 3)}) {
      write_file_atomically(tmp / "f", content, sync);
      EXPECT_EQ(content_of(tmp / "f"), content);
      EXPECT_EQ(names_in(tmp.path()), Names{"f"});
    }
  }
}

TEST(AtomicFile, ThatIsNotCommittedLeavesTheOldContent) {
  const TemporaryFolder tmp;
  put_file(tmp / "f", "old");
  {
    AtomicFile out(tmp / "f");
    out.write("new");
    EXPECT_EQ(names_in(tmp.path()).size(), 2U);
  }
  EXPECT_EQ(content_of(tmp / "f"), "old");
  EXPECT_EQ(names_in(tmp.path()), Names{"f"});
}

TEST(AtomicFile, IsTheSameInAnyPiecesAndZerosAreHoles) {
  const TemporaryFolder tmp;
  // Zeros at the begin, the end and in between; of less than a block, of one, and of more than what
  // is synced at a time.
  std::string content(9000, '\0');
  for (const std::size_t zeros : {1UL, 4095UL, 4096UL, 100000UL, 9UL << 20, 8192UL}) {
    content += std::string(5000, 'x') + std::string(zeros, '\0');
  }
  for (const std::size_t piece : {997UL, 4096UL, 1UL << 20, content.size()}) {
    AtomicFile out(tmp / "f");
    out.write("head");
    for (std::size_t i = 0; i < content.size(); i += piece) {
      out.write(std::string_view(content).substr(i, piece));
    }
    out.write_at(1, "EA");
    out.commit();
    EXPECT_TRUE(content_of(tmp / "f") == "hEAd" + content) << piece;
    struct stat info {};
    ASSERT_EQ(::stat((tmp / "f").c_str(), &info), 0);
    if (piece < 2 * 4096) continue;
    EXPECT_LT(512 * std::uint64_t(info.st_blocks), content.size() / 10);
  }
}

TEST(AtomicFile, ReplacesALinkNotWhatItPointsTo) {
  const TemporaryFolder tmp;
  put_file(tmp / "target", "old");
  std::filesystem::create_symlink("target", tmp / "f");
  write_file_atomically(tmp / "f", "new");
  EXPECT_EQ(content_of(tmp / "target"), "old");
  EXPECT_FALSE(std::filesystem::is_symlink(tmp / "f"));
}

TEST(AtomicFile, WhatCannotBeSyncedAtTheLastHasNotHappened) {
  const TemporaryFolder tmp;
  put_file(tmp / "old", "before");
  const FailingFiles failing(FileCall::fsync, tmp.path().filename().string());
  for (const char* name : {"old", "new"}) {
    EXPECT_THROW(write_file_atomically(tmp / name, "after"), std::system_error) << name;
  }
  EXPECT_EQ(content_of(tmp / "old"), "before");
  EXPECT_EQ(names_in(tmp.path()), Names{"old"});
  write_file_atomically(tmp / "old", "after", false);
  EXPECT_EQ(content_of(tmp / "old"), "after");
}

TEST(AtomicFile, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder tmp;
  put_file(tmp / "plain", "old");
  const auto below_a_file = tmp.path() / "plain" / "f";  // holds for root too
  const auto missing = tmp.path() / "nowhere" / "f";
  for (const auto& file : {below_a_file, missing}) {
    const auto write = [&] { write_file_atomically(file, "x"); };
    EXPECT_TRUE(contains(message_of<std::system_error>(write), file.string()));
  }
  EXPECT_EQ(names_in(tmp.path()), Names{"plain"});
}

TEST(AtomicFile, AFolderInTheWayIsAnErrorAndNoTemporaryStays) {
  const TemporaryFolder tmp;
  std::filesystem::create_directories(tmp.path() / "f" / "inside");
  const auto write = [&] { write_file_atomically(tmp / "f", "x"); };
  EXPECT_TRUE(contains(message_of<std::system_error>(write), (tmp / "f").string()));
  EXPECT_EQ(names_in(tmp.path()), Names{"f"});
}

/// A disk that is full after 4096 bytes, as far as one process can have it.
int write_on_a_full_disk(const std::filesystem::path& file) {
  ::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{4096, 4096};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
  try {
    write_file_atomically(file, std::string(100000, 'x'));
  } catch (const std::system_error& e) {
    return e.code().value() == EFBIG && contains(e.what(), file.string()) ? 0 : 3;
  }
  return 4;
}

TEST(AtomicFile, AFullDiskLeavesTheOldContentAndNoTemporary) {
  const TemporaryFolder tmp;
  put_file(tmp / "f", "old");
  EXPECT_EQ(status_in_child([&] { return write_on_a_full_disk(tmp / "f"); }), 0);
  EXPECT_EQ(content_of(tmp / "f"), "old");
  EXPECT_EQ(names_in(tmp.path()), Names{"f"});
}

TEST(AtomicFile, AReaderSeesOneWriterSContentWhole) {
  const TemporaryFolder tmp;
  const auto content = [](char c) { return std::string(20000, c); };
  write_file_atomically(tmp / "f", content('a'), false);
  std::atomic<int> running = 2;
  const auto write = [&](char c) {
    for (int i = 0; i < 200; ++i) write_file_atomically(tmp / "f", content(c), false);
    --running;
  };
  std::thread one(write, 'a'), two(write, 'b');
  bool whole = true;
  do {
    const std::string seen = read_file(tmp / "f", 1 << 20);
    whole = whole && !seen.empty() && seen == content(seen[0]);
  } while (running > 0);
  one.join();
  two.join();
  EXPECT_TRUE(whole);
  EXPECT_EQ(names_in(tmp.path()), Names{"f"});
}

TEST(ReadFile, ReadsUpToTheBoundAndNoFurther) {
  const TemporaryFolder tmp;
  const std::string content("\0\xff\n", 3);
  put_file(tmp / "f", content);
  EXPECT_EQ(read_file(tmp / "f", 3), content);
  const auto read = [&] { read_file(tmp / "f", 2); };
  EXPECT_TRUE(contains(message_of<std::length_error>(read), "at most 2 bytes"));
  // A file that says it has no bytes and has some.
  EXPECT_FALSE(read_file("/proc/self/status", 1 << 20).empty());
  EXPECT_THROW(read_file("/proc/self/status", 10), std::length_error);
}

TEST(ReadFile, ReadsRegularFilesOnly) {
  const TemporaryFolder tmp;
  put_file(tmp / "f", "x");
  std::filesystem::create_symlink("f", tmp / "link");
  std::filesystem::create_directory(tmp / "folder");
  ASSERT_EQ(::mkfifo((tmp / "fifo").c_str(), 0600), 0);
  for (const char* name : {"link", "folder", "fifo", "missing"}) {
    const auto read = [&] { read_file(tmp / name, 100); };
    EXPECT_TRUE(contains(message_of<std::system_error>(read), (tmp / name).string())) << name;
  }
}

TEST(Temporaries, OfDeadProcessesGoOnceTheyAreOld) {
  const TemporaryFolder tmp;
  const auto name_of_child = [&](const char* file) {
    // A name that a process made which is dead by now.
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    status_in_child([&] {
      const std::string name = temporary_name(tmp / file).filename().string();
      return ::write(ends[1], name.data(), name.size()) == ssize_t(name.size()) ? 0 : 1;
    });
    char name[256];
    const ssize_t n = ::read(ends[0], name, sizeof name);
    ::close(ends[0]);
    ::close(ends[1]);
    return std::string(name, std::size_t(std::max<ssize_t>(n, 0)));
  };
  const std::string dead_old = name_of_child("checkpoint.bin");
  const std::string dead_new = name_of_child("image.exr");
  const std::string mine = temporary_name(tmp / "f").filename().string();
  const Names others{".lock", ".x.tmp", ".hidden.12", "image.exr", ".a-b.99999999-0.tmp~"};
  const auto old = std::filesystem::file_time_type::clock::now() - std::chrono::hours(1);
  for (const std::string& name : {dead_old, dead_new, mine}) put_file(tmp / name, "x");
  for (const std::string& name : others) put_file(tmp / name, "x");
  for (const std::string& name : names_in(tmp.path())) {
    if (name != dead_new) std::filesystem::last_write_time(tmp / name, old);
  }
  remove_stale_temporaries(tmp.path());
  Names expected = others;
  expected.insert({dead_new, mine});
  EXPECT_EQ(names_in(tmp.path()), expected);
}

}  // namespace
}  // namespace lacuna
