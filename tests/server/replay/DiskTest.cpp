// A server whose disk stalls, is full, cannot be written, or loses unsynced data. A preloaded library
// (disk/disk.cpp) replaces the server's calls for its files.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/journal/Salvage.h"
#include "tests/server/replay/ServerFixture.h"
#include "tests/server/replay/disk/SyncNote.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;
using test::contentOf;
using test::waitUntil;

constexpr std::chrono::milliseconds kFrame{5};
constexpr std::chrono::milliseconds kLate{250};  ///< allowance for late ticks
/// The writer's syncs before this time are left out: the start of a round wakes it, later its own timer.
constexpr std::int64_t kWakeNanos = 1'500'000'000;
/// A longer pause between two syncs means that the writer slept, a shorter one that the disk was busy.
constexpr std::int64_t kSleepNanos = 100'000'000;

/// Returns the times from the start of a sync to the end of the next one, if the writer slept between them. A
/// power cut can lose this much.
std::vector<std::int64_t> periodsOf(const std::vector<SyncNote>& notes) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 0; i + 1 < notes.size(); ++i) {
    if (notes[i].began - notes[0].began > kWakeNanos && notes[i + 1].began - notes[i].ended > kSleepNanos)
      periods.push_back(notes[i + 1].ended - notes[i].began);
  }
  return periods;
}

class DiskTest : public test::ServerFixture {
 protected:
  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "a sanitizer's runtime has to be loaded first";
    fs::create_directory(disk);
  }
  void TearDown() override {
    if (player > 0) end(player, SIGKILL);
    if (server > 0) end(server, SIGKILL);
  }

  void start() {
    const std::string same = "--port=" + port();  // a recovered round needs the port its players know
    fs::remove(folder / "port");
    server = run({"dfserver", "--game=hello", "--insecure", same, "--port-file=port", "--journal=rounds",
                  "--control=control.sock", "--state=state", "--frame-time=5000"},
                 "out.txt",
                 {{"LD_PRELOAD", NAIAD_BINARY_DIR "/../lib/test_disk.so"}, {"DF_TEST_DISK", disk.string()}});
    ASSERT_TRUE(waitUntil([this] { return !contentOf(folder / "port").empty(); })) << log();
    if (player == 0) startPlayer();
  }
  /// Starts a player that reconnects by itself. Needed because without players the journal is written only
  /// every half minute.
  void startPlayer() {
    player = run({"dfbot", "127.0.0.1:" + port(), "--insecure", "--rejoin", "--random=1", "--seconds=3600"},
                 "player.txt");
    ASSERT_TRUE(isLogged("joined with")) << log();
  }
  void set(const char* name) const { std::ofstream(disk / name).flush(); }
  void unset(const char* name) const { fs::remove(disk / name); }
  std::vector<SyncNote> syncs() const {
    const std::string bytes = contentOf(disk / "syncs");
    std::vector<SyncNote> notes(bytes.size() / sizeof(SyncNote));
    std::copy_n(bytes.data(), notes.size() * sizeof(SyncNote), reinterpret_cast<char*>(notes.data()));
    return notes;
  }

  const fs::path disk = folder / "disk";  ///< folder that the library reads
  pid_t player = 0;
};

// If a tick waited for the disk, no tick would end while the disk stalls.
TEST_F(DiskTest, StalledDiskDoesNotBlockTicks) {
  start();
  ASSERT_TRUE(waitUntil([this] { return !syncs().empty(); })) << log();
  const bool is_long = std::getenv("NAIAD_LONG_TESTS") != nullptr;
  const std::chrono::milliseconds stall(is_long ? 10'000 : 1'500);
  const long late = status("late_ticks");
  const std::size_t before_stall = countTurns(round());
  set("stall");
  ASSERT_TRUE(waitUntil([this] { return fs::exists(disk / "stalled"); }));
  ASSERT_TRUE(playTicks(stall / kFrame)) << "ticks wait for the disk";
  RecordProperty("late_ticks", static_cast<int>(status("late_ticks") - late));
  if (is_long) std::printf("ticks of 5 ms during a stall of 10 s: %ld late\n", status("late_ticks") - late);
  unset("stall");
  const std::size_t before = syncs().size();
  ASSERT_TRUE(waitUntil([&] { return syncs().size() > before + 1; }));
  EXPECT_FALSE(test::has(log(), "no longer recording"));
  EXPECT_GT(countTurns(round()), before_stall) << "and they are in the file";
}

TEST_F(DiskTest, APowerCutLosesNoMoreThanASecond) {
  start();
  ASSERT_TRUE(waitUntil([this] { return periodsOf(syncs()).size() >= 2; })) << log();
  EXPECT_LE(std::ranges::min(periodsOf(syncs())), 1'000'000'000);
  ASSERT_TRUE(playTicks(100));
  end(server, SIGKILL);
  const std::chrono::nanoseconds cut_at = std::chrono::steady_clock::now().time_since_epoch();
  const SyncNote last = syncs().back();
  const std::string on_disk = contentOf(round()).substr(0, static_cast<std::size_t>(last.size));
  salvageRounds((folder / "rounds").string());  // completes the file from memory that a power cut would lose
  const std::size_t all = countTurns(round());
  std::ofstream(round(), std::ios::binary | std::ios::trunc) << on_disk << std::string(100, '\0');
  const std::size_t kept = countTurns(round());
  // The power cut loses the turns since the last sync began.
  EXPECT_LE(static_cast<long>(all - kept) * kFrame, cut_at - std::chrono::nanoseconds(last.began) + kLate);
  ASSERT_GT(kept, 0u);
  start();
  EXPECT_TRUE(isLogged("round recovered: replayed " + std::to_string(kept) + " ticks")) << log();
}

TEST_F(DiskTest, RoundOfAKilledServerSurvivesAStalledDisk) {
  set("stall");
  start();
  ASSERT_TRUE(playTicks(50)) << log();
  EXPECT_EQ(round(), fs::path()) << "the disk has nothing";
  end(server, SIGKILL);
  unset("stall");
  start();
  EXPECT_TRUE(isLogged("reconnected to the recovered round")) << log();
}

// The game continues without a journal, and the round cannot be handed over.
TEST_F(DiskTest, RoundWithAStoppedJournalIsNotHandedOver) {
  start();
  ASSERT_TRUE(waitUntil([this] { return !syncs().empty() && countTurns(round()) > 0; })) << log();
  set("full");
  EXPECT_TRUE(playTicks(10));  // otherwise there may be nothing to write
  for (int i = 0; i < 2; ++i) {
    const std::string said =
        test::Talk(folder / "control.sock").ask(R"({"command":"restart","arguments":{"when":"keep"}})");
    EXPECT_TRUE(test::has(said, "Cannot keep the round: its journal has stopped"));
  }
  EXPECT_TRUE(playTicks(100));
  const std::string cancelled = test::Talk(folder / "control.sock").ask(R"({"command":"cancel"})");
  EXPECT_TRUE(test::has(cancelled, "\"ok\":false")) << "nothing was planned: ";
  EXPECT_TRUE(isLogged("no longer recording the round, which continues: ")) << log();
  EXPECT_TRUE(test::has(log(), "No space left on device"));
  unset("full");
  end(server, SIGKILL);
  const std::string bytes = contentOf(round());
  EXPECT_EQ(DfrReader(bytes).header().flags & kDfrStopped, kDfrStopped);
  start();
  EXPECT_TRUE(isLogged("its journal is incomplete")) << log();
  EXPECT_TRUE(playTicks(10)) << "in another round";
}

TEST_F(DiskTest, ReadOnlyDiskIsLoggedAndTheGameContinues) {
  set("read-only");
  start();
  EXPECT_TRUE(isLogged("no longer recording the round, which continues: ")) << log();
  EXPECT_TRUE(test::has(log(), "Read-only file system"));
  EXPECT_TRUE(playTicks(100));
  EXPECT_EQ(round(), fs::path());
}

}  // namespace
}  // namespace naiad
