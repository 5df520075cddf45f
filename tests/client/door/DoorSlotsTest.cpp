#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <vector>

#include "client/door/DoorSlots.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using Refusal = DoorSlot::Refusal;

class DoorFolder : public testing::Test {
 protected:
  test::TempFolder folder;
};

class DoorSlots : public DoorFolder {
 protected:
  Refusal acquire(const std::string& visitor) {
    auto taken = DoorSlot::acquire(folder / "places", visitor, {.total = 4, .per_prefix = 2});
    if (taken.place) held.push_back(std::move(taken.place));
    return taken.refusal;
  }
  std::vector<std::unique_ptr<DoorSlot>> held;
};

TEST_F(DoorSlots, AreLimitedPerAddressAndInTotal) {
  EXPECT_EQ(acquire("192.0.2.7:1"), Refusal::kNone);
  EXPECT_EQ(acquire("192.0.2.7:2"), Refusal::kNone);
  EXPECT_EQ(acquire("192.0.2.7:3"), Refusal::kFullForPrefix);
  EXPECT_EQ(acquire("[2001:db8::1]:1"), Refusal::kNone);
  EXPECT_EQ(acquire("[2001:db8::2]:1"), Refusal::kNone);
  EXPECT_EQ(acquire("[2001:db8::3]:1"), Refusal::kFullForPrefix) << "of one /64";
  EXPECT_EQ(acquire("192.0.2.8:1"), Refusal::kFull);
  held.erase(held.begin());
  EXPECT_EQ(acquire("192.0.2.8:1"), Refusal::kNone);
}

TEST_F(DoorSlots, KilledProcessReleasesItsPlace) {
  int ready[2];
  ASSERT_EQ(pipe(ready), 0);
  const pid_t child = fork();
  if (child == 0) {
    const auto taken = DoorSlot::acquire(folder / "places", "192.0.2.7:1", {.total = 1, .per_prefix = 1});
    if (write(ready[1], taken.place ? "+" : "-", 1) != 1) _exit(1);
    for (;;) pause();
  }
  char sign = 0;
  ASSERT_EQ(read(ready[0], &sign, 1), 1);
  EXPECT_EQ(sign, '+');
  const DoorSlot::Limits one{.total = 1, .per_prefix = 1};
  EXPECT_EQ(DoorSlot::acquire(folder / "places", "192.0.2.8:1", one).refusal, Refusal::kFull);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(DoorSlot::acquire(folder / "places", "192.0.2.8:1", one).refusal, Refusal::kNone);
  close(ready[0]);
  close(ready[1]);
}

class VisitorFolders : public DoorFolder {};

TEST_F(VisitorFolders, AreNamedAfterTheAuthenticatedKey) {
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

TEST_F(VisitorFolders, CanBeUsedByOneProcessAtATime) {
  const auto first = VisitorFolder::open(folder, "a");
  ASSERT_TRUE(first && first->acquire());
  const auto second = VisitorFolder::open(folder, "a");
  EXPECT_FALSE(second->acquire());
  EXPECT_EQ(second->holder(), getpid());
  first->saveName("ann");
  EXPECT_EQ(second->name(), "ann");
}

TEST_F(VisitorFolders, AreLimitedAndUnusedOnesAreEvicted) {
  ASSERT_TRUE(VisitorFolder::open(folder, "a", 2));
  ASSERT_TRUE(VisitorFolder::open(folder, "b", 2));
  EXPECT_FALSE(VisitorFolder::open(folder, "c", 2));
  EXPECT_TRUE(VisitorFolder::open(folder, "a", 2)) << "one that is there";
  fs::last_write_time(folder / "b", fs::file_time_type::clock::now() - std::chrono::hours(24 * 31));
  EXPECT_TRUE(VisitorFolder::open(folder, "c", 2));
  EXPECT_FALSE(fs::exists(folder / "b"));
}

TEST_F(VisitorFolders, TemporaryFolderIsRemovedAfterTheVisit) {
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
