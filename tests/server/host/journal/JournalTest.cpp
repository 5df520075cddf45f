// A round's journal and the disk: the tick thread never waits for it, and a disk that fails costs the
// journal, not the game.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <system_error>
#include <thread>

#include "host/journal/DfrReader.h"
#include "host/journal/Journal.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/Salvage.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

/// A disk in memory, which stalls or fails as it is told.
struct Disk {
  std::mutex mutex;
  std::condition_variable changed;
  std::string bytes;
  std::uint16_t flags = 0;
  bool stalls = false;
  bool waits = false;  ///< somebody does
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

TEST(JournalTest, WhatIsAddedIsOnTheDiskAfterATurnOfTheWriter) {
  Disk disk;
  const auto journal = journalOn(disk);
  JournalWriter writer;
  writer.add(journal);
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  EXPECT_EQ(countTurns(disk.bytes), 100u);
  journal->finish("is over");
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  DfrReader reader(disk.bytes);
  while (reader.next()) continue;
  EXPECT_EQ(reader.end(), DfrEnd::kDone);
  EXPECT_EQ(reader.why(), "is over");
  EXPECT_EQ(journal->takeProblem(), std::nullopt);
}

// Who reads a file knows its facts before its first turn, also if they came while its header was written.
TEST(JournalTest, FactsAreBeforeTheRecordsThatWereAddedAfterThem) {
  Disk disk;
  const auto journal = journalOn(disk);
  JournalWriter writer;
  disk.setStalled(true);
  writer.add(journal);
  writer.wake();
  disk.waitUntilSomebodyWaits();
  journal->addFacts({{"file ship.txt", "1"}});
  ASSERT_TRUE(journal->add(turnRecord()));
  disk.setStalled(false);
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  DfrReader reader(disk.bytes);
  EXPECT_EQ(reader.facts().count("file ship.txt"), 1u);
  EXPECT_TRUE(reader.next());
}

// While the disk stalls, adding returns: this test would hang otherwise.
TEST(JournalTest, ADiskThatStallsKeepsNobodyWaiting) {
  Disk disk;
  const auto journal = journalOn(disk, std::size_t{1} << 20);
  JournalWriter writer;
  writer.add(journal);
  disk.setStalled(true);
  ASSERT_TRUE(journal->add(turnRecord()));
  writer.wake();
  disk.waitUntilSomebodyWaits();
  for (int tick = 0; tick < 300; ++tick) ASSERT_TRUE(journal->add(turnRecord()));  // ten seconds
  disk.setStalled(false);
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  EXPECT_EQ(countTurns(disk.bytes), 301u);
}

TEST(JournalTest, ADiskThatIsTooSlowForTheRingStopsTheJournal) {
  Disk disk;
  const auto journal = journalOn(disk);
  JournalWriter writer;
  writer.add(journal);
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  disk.setStalled(true);
  std::size_t added = 0;
  while (journal->add(turnRecord())) ++added;
  EXPECT_LE(added, kRing);
  EXPECT_EQ(journal->takeProblem(), "the disk is too slow");
  disk.setStalled(false);
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  EXPECT_EQ(disk.flags, kDfrStopped);
  EXPECT_EQ(journal->takeProblem(), std::nullopt) << "it is said once";
}

TEST(JournalTest, AFullDiskStopsTheJournalAndIsSaidOnce) {
  Disk disk;
  const auto journal = journalOn(disk);
  JournalWriter writer;
  writer.add(journal);
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  {
    const std::lock_guard lock(disk.mutex);
    disk.error = ENOSPC;
  }
  ASSERT_TRUE(journal->add(turnRecord()));
  ASSERT_TRUE(writer.drain(std::chrono::seconds(60)));
  EXPECT_FALSE(journal->add(turnRecord()));
  EXPECT_EQ(journal->takeProblem(), "disk: No space left on device");
  EXPECT_EQ(journal->takeProblem(), std::nullopt);
  EXPECT_EQ(disk.flags, kDfrStopped) << "nothing can go on from it";
  EXPECT_EQ(countTurns(disk.bytes), 1u);
}

class JournalFileTest : public testing::Test {
 protected:
  void SetUp() override {
    char name[] = "/tmp/naiad-journal-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder = name;
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder;
};

TEST_F(JournalFileTest, ItsFileIsForThisUserAlone) {
  const fs::path path = folder / "rounds" / "hello.dfr";
  JournalFileSink sink(path.string());
  sink.write(spellDfrHeader({}));
  sink.sync();
  sink.setFlags(kDfrStopped);
  struct stat facts {};
  ASSERT_EQ(stat(path.c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0600u);
  ASSERT_EQ(stat(path.parent_path().c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0700u);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(DfrReader(bytes).header().flags, kDfrStopped);
}

// What waits for the disk when the process is killed is in the file after the next start: no turn is lost.
TEST_F(JournalFileTest, AKilledServersRoundGetsTheTurnsThatHadNotReachedTheDisk) {
  const fs::path path = folder / "hello.dfr";
  DfrHeader header;
  header.uuid = {0x5A, static_cast<std::uint8_t>(getpid()), static_cast<std::uint8_t>(getpid() >> 8), 3};
  const pid_t child = fork();
  if (child == 0) {
    Journal journal(std::make_unique<JournalFileSink>(path.string()), header, {{"game", "hello"}}, kRing,
                    true);
    for (int i = 0; i < 100; ++i) journal.add(turnRecord());
    journal.flush();
    for (int i = 0; i < 50; ++i) journal.add(turnRecord());
    if (!journal.ring().isShared()) _exit(77);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "there is no /dev/shm";
  fs::resize_file(path, fs::file_size(path) + 7);  // torn in the middle of a chunk
  EXPECT_EQ(salvageRounds(folder.string()).size(), 1u);
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(countTurns(bytes), 150u);
  EXPECT_TRUE(salvageRounds(folder.string()).empty()) << "and the memory is free";
}

TEST_F(JournalFileTest, ARoundThatIsBeingPlayedIsLeftAlone) {
  const fs::path path = folder / "hello.dfr";
  DfrHeader header;
  header.uuid = {0x5B, static_cast<std::uint8_t>(getpid()), static_cast<std::uint8_t>(getpid() >> 8), 3};
  Journal journal(std::make_unique<JournalFileSink>(path.string()), header, {}, kRing, true);
  journal.add(turnRecord());
  journal.flush();
  journal.add(turnRecord());
  const auto size = fs::file_size(path);
  EXPECT_TRUE(salvageRounds(folder.string()).empty());
  EXPECT_EQ(fs::file_size(path), size);
}

TEST_F(JournalFileTest, MemoryOfARoundThatHasNoFileIsFreedByTheNextServerOfItsFolder) {
  const auto uuid = [self = getpid()](std::uint8_t first) {
    return std::array<std::uint8_t, 16>{first, static_cast<std::uint8_t>(self),
                                        static_cast<std::uint8_t>(self >> 8), 4};
  };
  const auto pathOf = [](const auto& round) { return "/dev/shm/naiad-" + uuidText(round); };
  const pid_t child = fork();
  if (child == 0) {
    const TurnRing ring(4096, uuid(1), true, 0, ringFolder(folder.string()));
    if (!ring.isShared()) _exit(77);
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "there is no /dev/shm";
  const TurnRing played(4096, uuid(2), true, 0, ringFolder(folder.string()));
  salvageRounds((folder / "another").string());
  EXPECT_TRUE(fs::exists(pathOf(uuid(1)))) << "it may be another server's, which is about to need it";
  salvageRounds(folder.string());
  EXPECT_FALSE(fs::exists(pathOf(uuid(1))));
  EXPECT_TRUE(fs::exists(pathOf(uuid(2)))) << "its process lives";
}

TEST_F(JournalFileTest, AFolderThatIsNotThereIsAnError) {
  JournalFileSink sink((folder / "none" / "rounds" / "hello.dfr").string());
  EXPECT_THROW(sink.write("x"), std::system_error);
}

TEST_F(JournalFileTest, NoFileIsWrittenOver) {
  std::ofstream(folder / "hello.dfr") << "kept";
  JournalFileSink sink((folder / "hello.dfr").string());
  EXPECT_THROW(sink.write("x"), std::system_error);
  std::string text;
  std::ifstream(folder / "hello.dfr") >> text;
  EXPECT_EQ(text, "kept");
}

TEST_F(JournalFileTest, TheOldestRoundsMakeRoom) {
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

TEST(TurnRingTest, BytesComeOutAsTheyWentInAcrossItsEnd) {
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

TEST(TurnRingTest, SharedMemoryIsForThisUserAloneAndGoesWithTheRing) {
  std::string path;
  {
    const TurnRing ring(4096, {0xAB, 0xCD}, true);
    if (!ring.isShared()) GTEST_SKIP() << "there is no /dev/shm";
    path = ring.path();
    struct stat facts {};
    ASSERT_EQ(stat(path.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777, 0600u);
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(TurnRingTest, OneThreadStoresWhileAnotherTakes) {
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
