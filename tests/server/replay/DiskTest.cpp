// A server whose disk stalls, is full, cannot be written, or loses what was not synced. A library that is
// loaded before all others (disk/disk.cpp) stands between the server and its disk.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/Salvage.h"
#include "tests/server/host/admin/Talk.h"
#include "tests/server/replay/disk/SyncNote.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kFrame{5};
constexpr std::chrono::seconds kPatience{60};
/// When a round begins the writer is woken; then it comes by itself.
constexpr std::int64_t kWakeNanos = 1'500'000'000;
/// A disk that takes longer than this is busy; a writer that waits longer than this sleeps.
constexpr std::int64_t kSleepNanos = 100'000'000;

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t countTurns(const fs::path& path) {
  const std::string bytes = bytesOf(path);
  DfrReader reader(bytes);
  std::size_t turns = 0;
  while (const auto record = reader.next()) turns += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
  return turns;
}

int countIn(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

/// From the begin of a sync to the end of the next, where the writer slept in between: what may be lost.
std::vector<std::int64_t> periodsOf(const std::vector<SyncNote>& notes) {
  std::vector<std::int64_t> periods;
  for (std::size_t i = 0; i + 1 < notes.size(); ++i) {
    if (notes[i].began - notes[0].began > kWakeNanos && notes[i + 1].began - notes[i].ended > kSleepNanos)
      periods.push_back(notes[i + 1].ended - notes[i].began);
  }
  return periods;
}

class DiskTest : public testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized) GTEST_SKIP() << "a sanitizer's runtime has to be loaded first";
    char name[] = "/tmp/naiad-disk-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder = name;
    disk = folder / "disk";
    fs::create_directory(disk);
  }
  void TearDown() override {
    if (server > 0) end(SIGKILL);
    if (!folder.empty()) fs::remove_all(folder);
  }

  void start() {
    const std::string known = bytesOf(folder / "port");  // a round goes on where its players look for it
    const std::string port = "--port=" + std::to_string(std::atoi(known.c_str()));
    fs::remove(folder / "port");
    server = fork();
    if (server == 0) {
      if (chdir(folder.c_str()) != 0) _exit(126);
      [[maybe_unused]] const bool out = freopen("out.txt", "a", stdout) != nullptr;
      [[maybe_unused]] const bool err = freopen("out.txt", "a", stderr) != nullptr;
      setenv("LD_PRELOAD", NAIAD_BINARY_DIR "/../lib/test_disk.so", 1);
      setenv("DF_TEST_DISK", disk.c_str(), 1);
      execl(NAIAD_BINARY_DIR "/dfserver", "dfserver", "--game=hello", "--insecure", port.c_str(),
            "--port-file=port", "--journal=rounds", "--control=control.sock", "--state=state",
            "--frame-time=5000", nullptr);
      _exit(127);
    }
    ASSERT_TRUE(waitUntil([this] { return !bytesOf(folder / "port").empty(); })) << log();
  }
  void end(int signal) {
    kill(server, signal);
    waitpid(server, nullptr, 0);
    server = 0;
  }
  template <class Done>
  static bool waitUntil(Done done) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!done()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // before it is looked at again
    }
    return true;
  }
  std::string log() const { return bytesOf(folder / "out.txt"); }
  bool isLogged(const std::string& text) const {
    return waitUntil([&] { return log().find(text) != std::string::npos; });
  }
  /// A number of dfctl status.
  long status(const std::string& name) const {
    const std::string answer = test::Talk(folder / "control.sock").ask(R"({"command":"status"})");
    const std::size_t at = answer.find("\"" + name + "\":");
    return at == std::string::npos ? -1 : std::atol(answer.c_str() + at + name.size() + 3);
  }
  bool playTicks(long count) const {
    const long end = status("ticks") + count;
    return waitUntil([&] { return status("ticks") >= end; });
  }
  void set(const char* name) const { std::ofstream(disk / name).flush(); }
  void unset(const char* name) const { fs::remove(disk / name); }
  std::vector<SyncNote> syncs() const {
    const std::string bytes = bytesOf(disk / "syncs");
    std::vector<SyncNote> notes(bytes.size() / sizeof(SyncNote));
    std::copy_n(bytes.data(), notes.size() * sizeof(SyncNote), reinterpret_cast<char*>(notes.data()));
    return notes;
  }
  fs::path round() const {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / "rounds", error)) return entry.path();
    return {};
  }

  fs::path folder;
  fs::path disk;  ///< what the library reads
  pid_t server = 0;
};

// If a tick waited for the disk, none would come while it stalls.
TEST_F(DiskTest, ADiskThatStallsHoldsUpNoTick) {
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
  EXPECT_EQ(log().find("not written down"), std::string::npos) << log();
  EXPECT_GT(countTurns(round()), before_stall) << "and they are in the file";
}

TEST_F(DiskTest, APowerCutLosesNoMoreThanASecond) {
  std::mt19937 random(5);
  const int cuts = std::getenv("NAIAD_LONG_TESTS") != nullptr ? 20 : 1;
  const std::string goes_on = "the round goes on after ";
  std::size_t kept = 0;
  for (int cut = 0; cut < cuts; ++cut) {
    start();
    // A round that three servers do not come to the end of is given up, so each has time for more of it.
    ASSERT_TRUE(waitUntil([&] { return countIn(log(), goes_on) == cut; })) << log();
    const std::size_t before = cut == 0 ? 0 : syncs().size() + 2;
    ASSERT_TRUE(waitUntil([&] {
      return cut == 0 ? periodsOf(syncs()).size() >= 2 : syncs().size() >= before;
    })) << log();
    if (cut == 0) {
      const std::vector<std::int64_t> periods = periodsOf(syncs());
      EXPECT_LE(*std::min_element(periods.begin(), periods.end()), 1'000'000'000);
    }
    ASSERT_TRUE(playTicks(static_cast<long>(random() % 200)));
    end(SIGKILL);
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const SyncNote last = syncs().back();
    const fs::path file = round();
    const std::string on_disk = bytesOf(file).substr(0, static_cast<std::size_t>(last.size));
    salvageRounds((folder / "rounds").string());  // all that the world got, by memory that a power cut takes
    const std::size_t all = countTurns(file);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << on_disk << std::string(100, '\0');
    kept = countTurns(file);
    ASSERT_GT(kept, 0u);
    const double seconds = static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / 1e9 -
                           static_cast<double>(last.began) / 1e9;
    // What came after the last sync began, and late ticks that were made up for.
    EXPECT_LE(static_cast<double>(all - kept) * 0.005, seconds + 0.25) << cut;
  }
  start();
  ASSERT_TRUE(waitUntil([&] { return countIn(log(), goes_on) == cuts; })) << log();
  EXPECT_EQ(std::atol(log().c_str() + log().rfind(goes_on) + goes_on.size()), static_cast<long>(kept))
      << log();
}

TEST_F(DiskTest, AFullDiskEndsTheJournalAndNotTheGame) {
  start();
  ASSERT_TRUE(waitUntil([this] { return !syncs().empty() && countTurns(round()) > 0; })) << log();
  set("full");
  EXPECT_TRUE(isLogged("the round is not written down any more, and goes on: ")) << log();
  EXPECT_NE(log().find("No space left on device"), std::string::npos) << log();
  EXPECT_TRUE(playTicks(100));
  unset("full");
  end(SIGKILL);
  const std::string bytes = bytesOf(round());
  EXPECT_EQ(DfrReader(bytes).header().flags & kDfrStopped, kDfrStopped);
  start();
  EXPECT_TRUE(isLogged("its journal had stopped before")) << log();
  EXPECT_TRUE(playTicks(10)) << "in another round";
}

// Nothing of it can go on elsewhere, and nothing ends for that.
TEST_F(DiskTest, ARoundThatAFullDiskEndedTheJournalOfIsNotKept) {
  start();
  ASSERT_TRUE(waitUntil([this] { return !syncs().empty() && countTurns(round()) > 0; })) << log();
  set("full");
  for (int i = 0; i < 2; ++i) {  // found by the proof, and known before it
    const std::string said =
        test::Talk(folder / "control.sock").ask(R"({"command":"restart","arguments":{"when":"keep"}})");
    EXPECT_NE(said.find("The round cannot be kept: its journal has stopped"), std::string::npos) << said;
  }
  EXPECT_TRUE(playTicks(100));
  const std::string cancelled = test::Talk(folder / "control.sock").ask(R"({"command":"cancel"})");
  EXPECT_NE(cancelled.find("\"ok\":false"), std::string::npos) << "nothing was planned: " << cancelled;
}

TEST_F(DiskTest, ADiskThatCannotBeWrittenIsSaidAndTheGameGoesOn) {
  set("read-only");
  start();
  EXPECT_TRUE(isLogged("the round is not written down any more, and goes on: ")) << log();
  EXPECT_NE(log().find("Read-only file system"), std::string::npos) << log();
  EXPECT_TRUE(playTicks(100));
  EXPECT_EQ(round(), fs::path());
}

}  // namespace
}  // namespace naiad
