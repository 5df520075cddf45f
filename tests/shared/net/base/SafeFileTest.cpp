#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "shared/net/base/SafeFile.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

struct SafeFileTest : testing::Test {
  std::ptrdiff_t filesThere() const { return std::distance(fs::directory_iterator(base.path()), {}); }

  test::TempFolder base;
  const fs::path path = base / "file";
};

TEST_F(SafeFileTest, ReplacedFileIsCompleteAndOwnerOnly) {
  std::ofstream(path) << "something longer, open to all";
  fs::permissions(path, fs::perms::owner_all | fs::perms::others_read);
  EXPECT_TRUE(isOpenToOthers(path));
  replaceFile(path, "new");
  EXPECT_EQ(readSmallFile(path, 3), "new");
  EXPECT_FALSE(isOpenToOthers(path));
  EXPECT_EQ(filesThere(), 1);
}

TEST_F(SafeFileTest, MakeFileDoesNotOverwrite) {
  EXPECT_TRUE(makeFile(path, "first"));
  EXPECT_FALSE(makeFile(path, "second"));
  EXPECT_EQ(readSmallFile(path, 100), "first");
  EXPECT_EQ(filesThere(), 1);
}

TEST_F(SafeFileTest, SystemErrorsAreThrown) {
  EXPECT_EQ(readSmallFile(path, 100), std::nullopt);
  makeFile(path, "four");
  EXPECT_THROW(readSmallFile(path, 3), std::system_error);
  EXPECT_THROW(readSmallFile(base, 100), std::system_error);
  EXPECT_THROW(replaceFile(base / "none" / "file", "x"), std::system_error);
  EXPECT_THROW(isOpenToOthers(base / "none"), std::system_error);
}

TEST_F(SafeFileTest, PipesAreRefusedWithoutBlocking) {
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_THROW(readSmallFile(path, 100), std::system_error);
  EXPECT_THROW(publishFile(path, "x"), std::system_error);
  EXPECT_TRUE(fs::is_fifo(path));
  EXPECT_THROW(requireRegular("/dev/null"), std::system_error);
  EXPECT_NO_THROW(requireRegular(base / "none"));
}

TEST_F(SafeFileTest, PublishReplacesALinkAndIsWorldReadable) {
  const fs::path other = base / "other";
  std::ofstream(other) << "precious";
  fs::create_symlink(other, path);
  publishFile(path, "new");
  EXPECT_EQ(readSmallFile(other, 100), "precious") << "the link was followed";
  EXPECT_EQ(readSmallFile(path, 100), "new");
  EXPECT_FALSE(fs::is_symlink(path));
  const mode_t mask = umask(0);
  umask(mask);
  struct stat facts {};
  ASSERT_EQ(stat(path.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0644U & ~mask);
  EXPECT_EQ(filesThere(), 2);
}

TEST_F(SafeFileTest, OpenReaderKeepsSeeingTheWholeOldFile) {
  publishFile(path, std::string(100'000, 'a'));
  std::ifstream reader(path);
  publishFile(path, std::string(100'000, 'b'));
  const std::string seen{std::istreambuf_iterator<char>(reader), {}};
  EXPECT_EQ(seen, std::string(100'000, 'a'));
}

TEST_F(SafeFileTest, LockIsHeldByOneAtATime) {
  std::atomic<int> inside{0};
  std::atomic<int> most{0};
  int rounds = 0;  // guarded by the lock
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) {
        const FileLock lock(base / "lock");
        most = std::max(most.load(), ++inside);
        ++rounds;
        --inside;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(most, 1);
  EXPECT_EQ(rounds, 800);
}

}  // namespace
}  // namespace naiad
