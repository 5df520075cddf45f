#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <thread>
#include <vector>

#include "client/door/DoorPlaces.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using Refusal = DoorPlace::Refusal;

class DoorFolder : public testing::Test {
 protected:
  test::TempFolder folder;
};

class DoorPlaces : public DoorFolder {
 protected:
  Refusal take(const std::string& visitor) {
    auto taken = DoorPlace::take(folder / "places", visitor, {.in_all = 4, .per_prefix = 2});
    if (taken.place) held.push_back(std::move(taken.place));
    return taken.refusal;
  }
  std::vector<std::unique_ptr<DoorPlace>> held;
};

TEST_F(DoorPlaces, AreLimitedPerAddressAndInTotal) {
  EXPECT_EQ(take("192.0.2.7:1"), Refusal::kNone);
  EXPECT_EQ(take("192.0.2.7:2"), Refusal::kNone);
  EXPECT_EQ(take("192.0.2.7:3"), Refusal::kFullForPrefix);
  EXPECT_EQ(take("[2001:db8::1]:1"), Refusal::kNone);
  EXPECT_EQ(take("[2001:db8::2]:1"), Refusal::kNone);
  EXPECT_EQ(take("[2001:db8::3]:1"), Refusal::kFullForPrefix) << "of one /64";
  EXPECT_EQ(take("192.0.2.8:1"), Refusal::kFull);
  held.erase(held.begin());
  EXPECT_EQ(take("192.0.2.8:1"), Refusal::kNone);
}

TEST_F(DoorPlaces, KilledProcessReleasesItsPlace) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto taken = DoorPlace::take(folder / "places", "192.0.2.7:1", {.in_all = 1, .per_prefix = 1});
    if (write(ready[1], taken.place ? "+" : "-", 1) != 1) _exit(1);
    for (;;) pause();
  }
  char sign = 0;
  ASSERT_EQ(read(ready[0], &sign, 1), 1);
  EXPECT_EQ(sign, '+');
  const DoorPlace::Limits one{.in_all = 1, .per_prefix = 1};
  EXPECT_EQ(DoorPlace::take(folder / "places", "192.0.2.8:1", one).refusal, Refusal::kFull);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(DoorPlace::take(folder / "places", "192.0.2.8:1", one).refusal, Refusal::kNone);
  close(ready[0]);
  close(ready[1]);
}

class KeyFolders : public DoorFolder {};

TEST_F(KeyFolders, AreNamedAfterTheAuthenticatedKey) {
  const auto ann = keyFolderName("publickey ssh-ed25519 AAAAC3ann\n");
  ASSERT_TRUE(ann);
  EXPECT_EQ(ann->size(), 64u);
  EXPECT_EQ(ann->find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(keyFolderName("keyboard-interactive\npublickey ssh-ed25519 AAAAC3ann\n"), ann);
  EXPECT_NE(keyFolderName("publickey ssh-ed25519 AAAAC3bob\n"), ann);
  for (const char* text : {"", "keyboard-interactive\n", "publickey ", "publickey\n", "password\n"})
    EXPECT_FALSE(keyFolderName(text)) << text;
  EXPECT_FALSE(keyFolderName("publickey " + std::string(20'000, 'x')));
}

TEST_F(KeyFolders, CanBeUsedByOneProcessAtATime) {
  const auto first = VisitorFolder::open(folder, "a");
  ASSERT_TRUE(first && first->take());
  const auto second = VisitorFolder::open(folder, "a");
  EXPECT_FALSE(second->take());
  EXPECT_EQ(second->holder(), getpid());
  first->keepName("ann");
  EXPECT_EQ(second->name(), "ann");
}

TEST_F(KeyFolders, AreLimitedAndUnusedOnesAreEvicted) {
  ASSERT_TRUE(VisitorFolder::open(folder, "a", 2));
  ASSERT_TRUE(VisitorFolder::open(folder, "b", 2));
  EXPECT_FALSE(VisitorFolder::open(folder, "c", 2));
  EXPECT_TRUE(VisitorFolder::open(folder, "a", 2)) << "one that is there";
  fs::last_write_time(folder / "b", fs::file_time_type::clock::now() - std::chrono::hours(24 * 31));
  EXPECT_TRUE(VisitorFolder::open(folder, "c", 2));
  EXPECT_FALSE(fs::exists(folder / "b"));
}

TEST_F(KeyFolders, TemporaryFolderIsRemovedAfterTheVisit) {
  fs::path path;
  {
    const auto visit = VisitorFolder::makeTemporary(folder / "visits");
    path = visit->path();
    EXPECT_TRUE(fs::is_directory(path));
  }
  EXPECT_FALSE(fs::exists(path));
}

}  // namespace
}  // namespace naiad
