// A round's journal and the disk: the tick thread never waits for the disk, and a failing disk ends the
// journal, not the game.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <system_error>
#include <thread>

#include "host/journal/DfrReader.h"
#include "host/journal/Journal.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/Salvage.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

/// A disk in memory that stalls or fails on request.
struct Disk {
  std::mutex mutex;
  std::condition_variable changed;
  std::string bytes;
  std::uint16_t flags = 0;
  bool stalls = false;
  bool waits = false;  ///< a write is waiting
  int error = 0;

  void setStalled(bool stalled) {
    const std::lock_guard lock(mutex);
    stalls = stalled;
    changed.notify_all();
  }
  void waitUntilSomebodyWaits() {
    std::unique_lock lock(mutex);
    changed.wait(lock, [this] { return waits; });
  }
};

class DiskSink : public JournalSink {
 public:
  explicit DiskSink(Disk& disk) : m_disk(disk) {}
  void write(std::string_view bytes) override {
    std::unique_lock lock(m_disk.mutex);
    m_disk.waits = m_disk.stalls;
    m_disk.changed.notify_all();
    m_disk.changed.wait(lock, [this] { return !m_disk.stalls; });
    m_disk.waits = false;
    if (m_disk.error != 0) throw std::system_error(m_disk.error, std::generic_category(), "disk");
    m_disk.bytes.append(bytes);
  }
  void sync() override {}
  void setFlags(std::uint16_t flags) override { m_disk.flags = flags; }

 private:
  Disk& m_disk;
};

std::string turnRecord() {
  std::string record;
  TurnRecordWriter().write(WorldTurn(), record);
  return record;
}

std::size_t countTurns(const std::string& bytes) {
  DfrReader reader(bytes);
  std::size_t count = 0;
  while (reader.next()) ++count;
  return count;
}

constexpr std::size_t kRing = 4096;

std::shared_ptr<Journal> journalOn(Disk& disk, std::size_t ring = kRing) {
  return std::make_shared<Journal>(std::make_unique<DiskSink>(disk), DfrHeader(), DfrFacts{{"game", "hello"}},
                                   ring, false);
}

/// A journal whose sink is the disk in memory, and its writer.
class JournalTest : public testing::Test {
 protected:
  void begin(std::size_t ring = kRing) {
    journal = journalOn(disk, ring);
    writer.add(journal);
  }
  bool drains() { return writer.drain(std::chrono::seconds(60)); }

  Disk disk;
  JournalWriter writer;
  std::shared_ptr<Journal> journal;
};

TEST_F(JournalTest, AddedRecordsAreOnDiskAfterDraining) {
  begin();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(drains());
  EXPECT_EQ(countTurns(disk.bytes), 100u);
  journal->finish("is over");
  ASSERT_TRUE(drains());
  DfrReader reader(disk.bytes);
  while (reader.next()) continue;
  EXPECT_EQ(reader.end(), DfrEnd::kDone);
  EXPECT_EQ(reader.endReason(), "is over");
  EXPECT_EQ(journal->popProblem(), std::nullopt);
}

// A reader gets the facts before the first turn, even if they came while the header was written.
TEST_F(JournalTest, FactsPrecedeRecordsAddedLater) {
  disk.setStalled(true);
  begin();
  writer.wake();
  disk.waitUntilSomebodyWaits();
  journal->addFacts({{"file ship.txt", "1"}});
  ASSERT_TRUE(journal->add(turnRecord()));
  disk.setStalled(false);
  ASSERT_TRUE(drains());
  DfrReader reader(disk.bytes);
  EXPECT_EQ(reader.facts().count("file ship.txt"), 1u);
  EXPECT_TRUE(reader.next());
}

// add() returns although the disk stalls; otherwise this test would hang.
TEST_F(JournalTest, StalledDiskDoesNotBlockTheTick) {
  begin(std::size_t{1} << 20);
  disk.setStalled(true);
  ASSERT_TRUE(journal->add(turnRecord()));
  writer.wake();
  disk.waitUntilSomebodyWaits();
  for (int tick = 0; tick < 300; ++tick) ASSERT_TRUE(journal->add(turnRecord()));  // ten seconds of ticks
  disk.setStalled(false);
  ASSERT_TRUE(drains());
  EXPECT_EQ(countTurns(disk.bytes), 301u);
}

TEST_F(JournalTest, DiskTooSlowForTheRingStopsTheJournal) {
  begin();
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(drains());
  disk.setStalled(true);
  std::size_t added = 0;
  while (journal->add(turnRecord())) ++added;
  EXPECT_LE(added, kRing);
  EXPECT_EQ(journal->popProblem(), "the disk is too slow");
  disk.setStalled(false);
  ASSERT_TRUE(drains());
  EXPECT_EQ(disk.flags, kDfrStopped);
  EXPECT_EQ(journal->popProblem(), std::nullopt) << "it is said once";
}

TEST_F(JournalTest, FullDiskStopsTheJournalAndIsReportedOnce) {
  begin();
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(drains());
  {
    const std::lock_guard lock(disk.mutex);
    disk.error = ENOSPC;
  }
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(drains());
  EXPECT_FALSE(journal->add(turnRecord()));
  EXPECT_EQ(journal->popProblem(), "disk: No space left on device");
  EXPECT_EQ(journal->popProblem(), std::nullopt);
  EXPECT_EQ(disk.flags, kDfrStopped) << "nothing can go on from it";
  EXPECT_EQ(countTurns(disk.bytes), 1u);
}

TEST_F(JournalTest, JournalWithoutPlayersSkipsMostFlushes) {
  journal = journalOn(disk);
  journal->setIdle(true);
  ASSERT_TRUE(journal->flush());
  EXPECT_FALSE(disk.bytes.empty()) << "the file is begun at once";
  journal->addFacts({{"first_tick", "1"}});
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(journal->flush());
  EXPECT_EQ(countTurns(disk.bytes), 1u) << "what is known of the round does not wait";
  for (int i = 1; i < Journal::kIdleFlushInterval; ++i) {
    ASSERT_TRUE(journal->add(turnRecord()));
    ASSERT_TRUE(journal->flush());
    ASSERT_EQ(countTurns(disk.bytes), 1u) << i;
  }
  ASSERT_TRUE(journal->flush());
  EXPECT_EQ(countTurns(disk.bytes), static_cast<std::size_t>(Journal::kIdleFlushInterval));
  ASSERT_TRUE(journal->add(turnRecord()));
  journal->setIdle(false);
  ASSERT_TRUE(journal->flush());
  EXPECT_EQ(countTurns(disk.bytes), static_cast<std::size_t>(Journal::kIdleFlushInterval) + 1)
      << "a player came";
  journal->setIdle(true);
  ASSERT_TRUE(journal->add(turnRecord()));
  journal->finish("is over");
  EXPECT_FALSE(journal->flush());
  EXPECT_EQ(countTurns(disk.bytes), static_cast<std::size_t>(Journal::kIdleFlushInterval) + 2);
}

class JournalFileTest : public testing::Test {
 protected:
  /// Returns a header with an id that no other process of this test uses.
  static DfrHeader headerOf(std::uint8_t first, std::uint8_t last = 3) {
    DfrHeader header;
    header.uuid = {first, static_cast<std::uint8_t>(getpid()), static_cast<std::uint8_t>(getpid() >> 8),
                   last};
    return header;
  }

  const test::TempFolder folder;
};

TEST_F(JournalFileTest, ItsFileIsForThisUserAlone) {
  const fs::path path = folder / "rounds" / "hello.dfr";
  JournalFileSink sink(path.string());
  sink.write(encodeDfrHeader({}));
  sink.sync();
  sink.setFlags(kDfrStopped);
  EXPECT_EQ(test::modeOf(path), 0600u);
  EXPECT_EQ(test::modeOf(path.parent_path()), 0700u);
  const std::string bytes = test::contentOf(path);
  EXPECT_EQ(DfrReader(bytes).header().flags, kDfrStopped);
}

/// Kills this process, which has this memory.
void die(const TurnRing& ring) {
  if (!ring.isShared()) _exit(77);
  kill(getpid(), SIGKILL);
}

/// Calls `play` in another process. It calls die(). False if its memory is not shared with other processes.
template <class Play>
bool isKilled(Play play) {
  const pid_t child = fork();
  if (child == 0) play();
  int status = 0;
  EXPECT_EQ(waitpid(child, &status, 0), child);
  return WIFSIGNALED(status);
}

// Records still in memory when the process is killed are written at the next start: no turn is lost.
TEST_F(JournalFileTest, SalvageRecoversUnwrittenTurnsOfAKilledServer) {
  const fs::path path = folder / "hello.dfr";
  const DfrHeader header = headerOf(0x5A);
  const bool has_memory = isKilled([&] {
    Journal journal(std::make_unique<JournalFileSink>(path.string()), header, {{"game", "hello"}}, kRing,
                    true);
    for (int i = 0; i < 100; ++i) journal.add(turnRecord());
    journal.flush();
    for (int i = 0; i < 50; ++i) journal.add(turnRecord());
    die(journal.ring());
  });
  if (!has_memory) GTEST_SKIP() << "there is no /dev/shm";
  fs::resize_file(path, fs::file_size(path) + 7);  // an incomplete chunk at the end
  EXPECT_EQ(salvageRounds(folder.string()).size(), 1u);
  EXPECT_EQ(countTurns(test::contentOf(path)), 150u);
  EXPECT_TRUE(salvageRounds(folder.string()).empty()) << "and the memory is free";
}

TEST_F(JournalFileTest, SalvageReportsTurnsLostFromATruncatedFile) {
  const fs::path path = folder / "hello.dfr";
  const bool has_memory = isKilled([&] {
    Journal journal(std::make_unique<JournalFileSink>(path.string()), headerOf(0x5E), {}, kRing, true);
    for (std::size_t bytes = 0; bytes < 3 * kRing; bytes += turnRecord().size()) {
      journal.add(turnRecord());
      journal.flush();
    }
    die(journal.ring());
  });
  if (!has_memory) GTEST_SKIP() << "there is no /dev/shm";
  fs::resize_file(path, fs::file_size(path) / 3);
  const std::vector<std::string> said = salvageRounds(folder.string());
  ASSERT_EQ(said.size(), 1u);
  EXPECT_TRUE(test::has(said[0], "turns are lost, because the file is shorter than it was"));
}

// The file is created by another thread, some time after the world's first turns.
TEST_F(JournalFileTest, SalvageCreatesAMissingOrIncompleteRoundFile) {
  const fs::path path = folder / "hello-first.dfr";
  DfrHeader header = headerOf(0x5C);
  header.seed = 7;
  for (const bool is_made : {false, true}) {
    const bool has_memory = isKilled([&] {
      Journal journal(std::make_unique<JournalFileSink>(path.string()), header, {{"game", "hello"}}, kRing,
                      true, std::nullopt, ringFolder(folder.string()), path.filename().string());
      for (int i = 0; i < 20; ++i) journal.add(turnRecord());
      if (is_made) std::ofstream(path) << "NA";  // not even the header is complete
      die(journal.ring());
    });
    if (!has_memory) GTEST_SKIP() << "there is no /dev/shm";
    EXPECT_EQ(fs::exists(path), is_made);
    EXPECT_EQ(salvageRounds(folder.string()).size(), 1u);
    const std::string bytes = test::contentOf(path);
    EXPECT_EQ(countTurns(bytes), 20u);
    const DfrReader reader(bytes);
    EXPECT_EQ(reader.header().seed, 7u);
    EXPECT_EQ(reader.facts().at("game"), "hello");
    EXPECT_TRUE(salvageRounds(folder.string()).empty()) << "and the memory is free";
    fs::remove(path);
  }
}

// The shared memory belongs to this user, but a name in it must not become a path outside the folder.
TEST_F(JournalFileTest, RingCannotNameFilesOutsideItsFolder) {
  std::uint8_t number = 0;
  for (const std::string name : {"../escaped.dfr", "/tmp/naiad-escaped.dfr", ".dfr", "hello.so", "..dfr"}) {
    ++number;
    const bool has_memory = isKilled([&] {
      const DfrHeader header = headerOf(0x5D, number);
      Journal journal(std::make_unique<JournalFileSink>((folder / "x.dfr").string()), header, {}, kRing, true,
                      std::nullopt, ringFolder((folder / "rounds").string()), name);
      journal.add(turnRecord());
      die(journal.ring());
    });
    if (!has_memory) GTEST_SKIP() << "there is no /dev/shm";
  }
  fs::create_directory(folder / "rounds");
  EXPECT_TRUE(salvageRounds((folder / "rounds").string()).empty());
  EXPECT_TRUE(fs::is_empty(folder / "rounds"));
  EXPECT_FALSE(fs::exists(folder / "escaped.dfr"));
  EXPECT_FALSE(fs::exists("/tmp/naiad-escaped.dfr"));
}

TEST_F(JournalFileTest, ARoundThatIsBeingPlayedIsLeftAlone) {
  const fs::path path = folder / "hello.dfr";
  Journal journal(std::make_unique<JournalFileSink>(path.string()), headerOf(0x5B), {}, kRing, true);
  journal.add(turnRecord());
  journal.flush();
  journal.add(turnRecord());
  const auto size = fs::file_size(path);
  EXPECT_TRUE(salvageRounds(folder.string()).empty());
  EXPECT_EQ(fs::file_size(path), size);
}

TEST_F(JournalFileTest, NextServerFreesMemoryOfUnsavedRounds) {
  const auto dead = headerOf(1, 4).uuid;
  const auto lives = headerOf(2, 4).uuid;
  const auto pathOf = [](const auto& round) { return "/dev/shm/naiad-" + uuidText(round); };
  const bool has_memory = isKilled([&] {
    const TurnRing ring(4096, dead, true, 0, ringFolder(folder.string()));
    die(ring);
  });
  if (!has_memory) GTEST_SKIP() << "there is no /dev/shm";
  const TurnRing played(4096, lives, true, 0, ringFolder(folder.string()));
  salvageRounds((folder / "another").string());
  EXPECT_TRUE(fs::exists(pathOf(dead))) << "it may be another server's, which is about to need it";
  salvageRounds(folder.string());
  EXPECT_FALSE(fs::exists(pathOf(dead)));
  EXPECT_TRUE(fs::exists(pathOf(lives))) << "its process lives";
}

TEST_F(JournalFileTest, MissingFolderIsAnError) {
  JournalFileSink sink((folder / "none" / "rounds" / "hello.dfr").string());
  EXPECT_THROW(sink.write("x"), std::system_error);
}

TEST_F(JournalFileTest, ExistingFileIsNotOverwritten) {
  std::ofstream(folder / "hello.dfr") << "kept";
  JournalFileSink sink((folder / "hello.dfr").string());
  EXPECT_THROW(sink.write("x"), std::system_error);
  EXPECT_EQ(test::contentOf(folder / "hello.dfr"), "kept");
}

TEST_F(JournalFileTest, OldestRoundsAreDeletedBeyondTheLimit) {
  for (std::size_t i = 0; i < JournalFileSink::kMaxFiles + 5; ++i) {
    const fs::path path = folder / ("old-" + std::to_string(i) + ".dfr");
    std::ofstream(path) << i;
    fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1000 - i));
  }
  std::ofstream(folder / "notes.txt") << "of somebody";
  JournalFileSink sink((folder / "new.dfr").string());
  sink.write("x");
  EXPECT_FALSE(fs::exists(folder / "old-5.dfr"));
  EXPECT_TRUE(fs::exists(folder / "old-6.dfr"));
  EXPECT_TRUE(fs::exists(folder / "new.dfr"));
  EXPECT_TRUE(fs::exists(folder / "notes.txt"));
}

TEST_F(JournalFileTest, SizeLimitDeletesOldRoundsExceptTheOnePlayed) {
  JournalFileSink played((folder / "a.dfr").string());
  played.write(std::string(400, 'x'));
  const auto now = fs::file_time_type::clock::now();
  for (const char* name : {"b.dfr", "c.dfr", "d.dfr"}) {
    std::ofstream(folder / name) << std::string(400, 'x');
    fs::last_write_time(folder / name, now - std::chrono::hours('z' - name[0]));
  }
  fs::last_write_time(folder / "a.dfr", now - std::chrono::hours(1000));
  removeOldRounds(folder.string(), 100, 1600);
  EXPECT_TRUE(fs::exists(folder / "b.dfr"));
  removeOldRounds(folder.string(), 100, 1599);
  EXPECT_TRUE(fs::exists(folder / "a.dfr")) << "a server writes it";
  EXPECT_FALSE(fs::exists(folder / "b.dfr"));
  EXPECT_TRUE(fs::exists(folder / "c.dfr"));
  removeOldRounds(folder.string(), 1, 1600);
  EXPECT_TRUE(fs::exists(folder / "a.dfr"));
  EXPECT_FALSE(fs::exists(folder / "d.dfr"));
}

TEST_F(JournalFileTest, RoundFileSizeIsLimited) {
  const fs::path path = folder / "long.dfr";
  std::ofstream(path) << "x";
  fs::resize_file(path, kMaxRoundFile - 10);
  JournalFileSink sink(path.string(), kMaxRoundFile - 10);
  sink.write(std::string(10, 'x'));
  EXPECT_EQ(test::codeOf<std::system_error>([&] { sink.write("x"); }).value(), EFBIG);
  EXPECT_EQ(fs::file_size(path), kMaxRoundFile);
}

TEST(TurnRingTest, WrapAroundPreservesBytesAndFullRingRejects) {
  TurnRing ring(100, {}, false);
  std::string in;
  std::string out;
  for (int i = 0; i < 50; ++i) {
    const std::string part(static_cast<std::size_t>(i % 37), static_cast<char>('a' + i % 26));
    ASSERT_TRUE(ring.store(part));
    in += part;
    ring.release(ring.peek(out, 1000));
  }
  EXPECT_EQ(in, out);
  EXPECT_FALSE(ring.store(std::string(101, 'x')));
  EXPECT_TRUE(ring.store(std::string(100, 'x')));
  EXPECT_FALSE(ring.store("x"));
  EXPECT_TRUE(ring.isFilling());
}

TEST(TurnRingTest, SharedMemoryIsPrivateAndRemovedWithTheRing) {
  std::string path;
  {
    const TurnRing ring(4096, {0xAB, 0xCD}, true);
    if (!ring.isShared()) GTEST_SKIP() << "there is no /dev/shm";
    path = ring.path();
    EXPECT_EQ(test::modeOf(path), 0600u);
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TurnRingTest, ConcurrentStoreAndReadLoseNoBytes) {
  TurnRing ring(1000, {}, false);
  constexpr int kParts = 20'000;
  std::string out;
  std::thread taker([&] {
    while (out.size() < std::size_t{kParts} * 7) ring.release(ring.peek(out, 300));
  });
  for (int i = 0; i < kParts; ++i) {
    while (!ring.store(std::string(7, static_cast<char>(i)))) std::this_thread::yield();
  }
  taker.join();
  for (int i = 0; i < kParts; ++i) ASSERT_EQ(out[static_cast<std::size_t>(i) * 7 + 6], static_cast<char>(i));
}

}  // namespace
}  // namespace naiad
