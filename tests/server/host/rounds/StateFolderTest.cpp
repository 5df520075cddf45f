// Files of a server's state that another user or a mistake put there. If a file is opened without the checks,
// a pipe blocks this process until the time limit of the tests.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "host/admin/BanList.h"
#include "host/auth/ServerIdentity.h"
#include "host/journal/JournalSink.h"
#include "host/journal/Salvage.h"
#include "host/journal/TurnRing.h"
#include "host/rounds/RoundJournals.h"
#include "host/scores/ScoreStore.h"
#include "host/settings/HostOptions.h"
#include "tests/server/host/admin/Talk.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

constexpr uid_t kAnotherUser = 12345;

/// A way to put a file at `path` that must not be used. `good`: a file that may be used. Returns false if
/// this user or machine cannot do it.
struct Hostile {
  std::string name;
  std::function<bool(const fs::path& path, const fs::path& good)> make;
  bool is_used_if_provided = false;  ///< allowed for files that the host provides (Links::kFollowed)
};

void PrintTo(const Hostile& hostile, std::ostream* p_out) {
  *p_out << hostile.name;
}

bool copyWithMode(const fs::path& path, const fs::path& good, mode_t mode) {
  return fs::copy_file(good, path) && ::chmod(path.c_str(), mode) == 0;
}

const Hostile kHostile[] = {
    {"pipe", [](const auto& path, const auto&) { return ::mkfifo(path.c_str(), 0600) == 0; }},
    {"socket", [](const auto& path, const auto&) { return test::leaveSocket(path); }},
    {"folder", [](const auto& path, const auto&) { return fs::create_directory(path); }},
    {"device",
     [](const auto& path, const auto&) { return ::mknod(path.c_str(), S_IFCHR | 0600, makedev(1, 5)) == 0; }},
    {"link", [](const auto& path, const auto& good) { return ::symlink(good.c_str(), path.c_str()) == 0; },
     true},
    {"dangling_link",
     [](const auto& path, const auto& good) {
       return ::symlink((good.string() + ".none").c_str(), path.c_str()) == 0;
     }},
    {"of_another_user",
     [](const auto& path, const auto& good) {
       return copyWithMode(path, good, 0600) && ::chown(path.c_str(), kAnotherUser, kAnotherUser) == 0;
     }},
    {"writable_by_group", [](const auto& path, const auto& good) { return copyWithMode(path, good, 0620); },
     true},
    {"writable_by_all", [](const auto& path, const auto& good) { return copyWithMode(path, good, 0602); }},
    {"unreadable",
     [](const auto& path, const auto& good) { return ::geteuid() != 0 && copyWithMode(path, good, 0000); }},
};

/// A kind of file in a server's state.
struct StateKind {
  std::string name;
  std::string good;  ///< name of a good file in the folder `good`
  std::string path;  ///< name for its use, in the folder `state` unless absolute
  std::function<bool(const fs::path& path)> is_used;  ///< uses the file
  bool is_provided = false;                           ///< Links::kFollowed
};

const DfrFacts kExpected{{kFactGame, "hello"}, {kFactPort, "1"}, {kFactClocks, "repeatable"}};
/// The id of a round that no other process of this test uses.
const std::array<std::uint8_t, 16> kRound{0x7F, static_cast<std::uint8_t>(getpid()),
                                          static_cast<std::uint8_t>(getpid() >> 8)};

template <class Action>
bool works(Action action) {
  try {
    return action();
  } catch (const std::exception&) {
    return false;
  }
}

class StateFolderTest : public testing::TestWithParam<Hostile> {
 protected:
  StateFolderTest() {
    fs::create_directory(state);
    fs::create_directory(good);
    ServerIdentity::loadOrMake(good, std::chrono::system_clock::now());
    std::ofstream(good / "server.conf") << "ticks = 3\n";
    BanStore(good / "bans.sqlite3").save({.name = "eve"});
    ScoreStore(good / "scores.sqlite3", "hello").save({{.table = "t", .name = "ann", .round = "r"}});
    std::string records;
    TurnRecordWriter().write(WorldTurn(), records);
    DfrHeader header;
    header.uuid = kRound;
    std::ofstream(good / "hello.dfr")
        << encodeDfrHeader(header) << encodeDfrMeta(kExpected) << encodeDfrTurns(records, 0);
    TurnRing ring(4096, kRound, true);
    ring.store(records);
    ring.handOver();
    if (!ring.isShared()) return;
    std::ofstream(good / "ring") << test::contentOf(ring.path());
    ring_path = ring.path();
  }
  ~StateFolderTest() override {
    if (!ring_path.empty()) fs::remove_all(ring_path);
  }

  std::vector<StateKind> kinds() {
    std::vector<StateKind> all{
        {"key", "key.pem", "key.pem",
         [this](const auto& path) {
           return works([&] { return ServerIdentity::load(good / "certificate.pem", path), true; });
         },
         true},
        {"certificate", "certificate.pem", "certificate.pem",
         [this](const auto& path) {
           return works([&] { return ServerIdentity::load(path, good / "key.pem"), true; });
         },
         true},
        {"configuration", "server.conf", "server.conf",
         [](const auto& path) {
           const char* const words[] = {"dfserver", "--config", path.c_str()};
           return works([&] { return readHostOptions(3, words).ticks == 3; });
         },
         true},
        {"bans", "bans.sqlite3", "bans.sqlite3",
         [](const auto& path) { return works([&] { return BanStore(path).load().size() == 1; }); }},
        {"scores", "scores.sqlite3", "scores.sqlite3",
         [](const auto& path) {
           return works([&] { return ScoreStore(path, "hello").best("", 1).size() == 1; });
         }},
        {"scores' log", "server.conf", "scores.sqlite3-wal",
         [this](const auto&) {
           fs::copy_file(good / "scores.sqlite3", state / "scores.sqlite3");
           return works(
               [&] { return ScoreStore(state / "scores.sqlite3", "hello").best("", 1).size() == 1; });
         }},
        {"round to resume", "hello.dfr", "hello.dfr",
         [this](const auto&) {
           std::vector<std::string> said;
           const auto found = findUnfinishedRound(state.string(), kExpected, 0, said);
           EXPECT_EQ(said.size(), found == nullptr ? 1u : 0u);
           return found != nullptr;
         }},
        {"round to read", "hello.dfr", "hello.dfr",
         [](const auto& path) { return works([&] { return UnfinishedRound(path.string()).turns() == 1; }); }},
        {"round to continue", "hello.dfr", "hello.dfr",
         [](const auto& path) {
           return works([&] { return JournalFileSink(path.string(), kDfrHeaderSize), true; });
         }},
        {"round to remove", "hello.dfr", "hello.dfr", [this](const auto& path) {
           removeOldRounds(state.string(), 0, 0);
           return fs::symlink_status(path).type() == fs::file_type::not_found;
         }}};
    if (ring_path.empty()) return all;
    all.push_back(
        {"ring", "ring", ring_path, [](const auto&) { return OrphanedRing::find(kRound).has_value(); }});
    all.push_back({"round to complete", "hello.dfr", "hello.dfr", [this](const auto&) {
                     fs::copy_file(good / "ring", ring_path);
                     const bool is_completed = !salvageRounds(state.string()).empty();
                     fs::remove(ring_path);
                     return is_completed;
                   }});
    return all;
  }
  bool isUsed(const StateKind& kind, const std::function<bool(const fs::path&, const fs::path&)>& make,
              bool& is_made) {
    const fs::path path = state / kind.path;
    fs::remove_all(path);
    is_made = make(path, good / kind.good);
    const bool is_used = is_made && kind.is_used(path);
    fs::remove_all(path);
    fs::remove_all(state);
    fs::create_directory(state);
    return is_used;
  }

  const test::TempFolder base;
  const fs::path state = base / "state";
  const fs::path good = base / "good";
  std::string ring_path;  ///< empty without shared memory
};

TEST_P(StateFolderTest, OnlyOwnRegularFilesAreUsed) {
  const std::string before = test::contentOf(good / "hello.dfr");
  for (const StateKind& kind : kinds()) {
    SCOPED_TRACE(kind.name);
    bool is_made = false;
    if (kind.name != "scores' log") {
      EXPECT_TRUE(isUsed(
          kind, [](const auto& path, const auto& file) { return copyWithMode(path, file, 0600); }, is_made))
          << "a good file";
    }
    const bool is_used = isUsed(kind, GetParam().make, is_made);
    if (!is_made) GTEST_SKIP() << "this user cannot make such a file";
    const bool is_private = kind.name == "key" && GetParam().name == "writable_by_group";
    EXPECT_EQ(is_used, GetParam().is_used_if_provided && kind.is_provided && !is_private);
  }
  EXPECT_EQ(test::contentOf(good / "hello.dfr"), before) << "a link was followed";
}

INSTANTIATE_TEST_SUITE_P(Kinds, StateFolderTest, testing::ValuesIn(kHostile),
                         [](const auto& kind) { return kind.param.name; });

class FindRound : public testing::Test {
 protected:
  /// Returns a round of one tick. A later `start` is newer.
  static std::string roundOf(std::uint64_t start, const DfrFacts& changed = {}, const std::string& end = "") {
    DfrHeader header;
    header.start_nanos = start;
    DfrFacts facts = changed;
    facts.insert(kExpected.begin(), kExpected.end());
    std::string records;
    TurnRecordWriter().write(WorldTurn(), records);
    return encodeDfrHeader(header) + encodeDfrMeta(facts) + encodeDfrTurns(records, 0) + end;
  }
  void add(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
  /// Returns the name of the round to resume; empty without one.
  std::string find() {
    said.clear();
    const auto found = findUnfinishedRound(folder.string(), kExpected, 0, said);
    return found != nullptr ? fs::path(found->path()).filename().string() : "";
  }

  const test::TempFolder folder;
  std::vector<std::string> said;
};

TEST_F(FindRound, EachRoundNotResumedHasOneLine) {
  const std::string good = roundOf(5);
  add("hello-1.dfr", good);
  std::string damaged = roundOf(6);
  damaged[40] = 'X';
  std::string other_version = roundOf(6);
  other_version[8] = 9;
  const std::pair<std::string, std::pair<std::string, std::string>> refused[] = {
      {"damaged header", {"hello-2.dfr", damaged}},
      {"format version 9", {"hello-2.dfr", other_version}},
      {"truncated before the first chunk", {"hello-2.dfr", good.substr(0, 30)}},
      {"truncated before its first tick", {"hello-2.dfr", roundOf(6).substr(0, kDfrHeaderSize + 20)}},
      {"not a round recording", {"hello-2.dfr", "PK"}},
      {"a round of the game hello-x", {"hello-x-2.dfr", roundOf(6, {{kFactGame, "hello-x"}})}},
  };
  for (const auto& [reason, file] : refused) {
    add(file.first, file.second);
    EXPECT_EQ(find(), "hello-1.dfr") << reason;
    ASSERT_EQ(said.size(), 1u) << reason;
    EXPECT_TRUE(test::has(said[0], file.first + ": " + reason));
    EXPECT_TRUE(said[0].starts_with("cannot recover the round: "));
    fs::remove(folder / file.first);
  }
  // The newest round of this game decides.
  for (const auto& [reason, changed] :
       {std::pair<std::string, DfrFacts>{"players differs", {{kFactPlayers, "x"}}},
        {"clocks were not repeatable", {{kFactClocks, "real"}}}}) {
    add("hello-2.dfr", roundOf(6, changed));
    EXPECT_EQ(find(), "");
    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(test::has(said[0], reason));
  }
}

TEST_F(FindRound, OtherServersAndFinishedRoundsHaveNoLine) {
  add("hello-1.dfr", roundOf(5));
  add("hello-2.dfr", roundOf(6, {{kFactPort, "2"}}));
  add("hello-x-3.dfr", roundOf(7, {{kFactGame, "hello-x"}}, encodeDfrDone("over")));
  add("hello-x-4.dfr", roundOf(4, {{kFactGame, "hello-x"}}));  // reported when it was the newest
  EXPECT_EQ(find(), "hello-1.dfr");
  EXPECT_TRUE(said.empty()) << said.front();
  add("hello-5.dfr", roundOf(8, {}, encodeDfrDone("over")));
  EXPECT_EQ(find(), "");
  EXPECT_TRUE(said.empty()) << said.front();
}

TEST_F(FindRound, TicksLostFromADamagedEndAreReported) {
  const std::string records = roundOf(5);
  for (const std::string& end :
       {std::string("torn"), records.substr(kDfrHeaderSize, 40), std::string(50, '\0')}) {
    add("hello-1.dfr", records + end);
    EXPECT_EQ(find(), "hello-1.dfr");
    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(test::has(said[0], "ticks of the round are lost, because the last " +
                                       std::to_string(end.size()) + " bytes of "));
  }
}

}  // namespace
}  // namespace naiad
