// The file format of rounds. A written file can be read, and a truncated, changed or hostile file is read up
// to the first fault.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/RecordCoder.h"
#include "shared/values/LittleEndian.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

WorldTurn randomTurn(SplitMix64& random) {
  WorldTurn turn;
  turn.watched = random.below(10) != 0;
  turn.checked = random.below(30) == 0;
  turn.rendered_player = random.below(50) == 0 ? 3 : 0;
  for (std::uint64_t i = random.below(4); i > 0; --i) {
    df::InputQueue::Input input{df::InputQueue::kKey, static_cast<std::uint32_t>(1 + random.below(4))};
    input.key = static_cast<df::Keyboard::Key>(random.below(40));
    input.key_action = df::KEY_PRESSED;
    if (random.below(5) == 0) {
      input = {df::InputQueue::kJoin, 7};
      input.name = "Ann";
      input.color = df::RED;
    }
    turn.inputs.push_back(input);
  }
  return turn;
}

/// A file, and the number of records before the end of each chunk.
struct SmallFile {
  std::string bytes;
  std::vector<std::pair<std::size_t, std::size_t>> records_at;
  std::size_t done_at = 0;

  explicit SmallFile(int chunks = 6) {
    bytes = encodeDfrHeader(
        {.uuid = {1, 2, 3}, .frame_nanos = 33'333'333, .seed = 42, .start_nanos = 1'700'000'000'000'000'000});
    bytes += encodeDfrMeta({{"game", "hello"}, {"players", "together"}});
    SplitMix64 random(5);
    DfrTurnPacker packer;
    TurnRecordWriter writer;
    std::size_t count = 0;
    for (int i = 0; i < chunks; ++i) {
      std::string records;
      for (int t = 0; t < 5; ++t) {
        writer.write(randomTurn(random), records);
        TickResult result;
        result.has_check = true;
        result.check = static_cast<std::uint8_t>(random.next());
        if (t == 2) result.state_hash = random.next();
        writer.write(result, records);
        count += 2;
      }
      bytes += packer.pack(records);
      records_at.emplace_back(bytes.size(), count);
      if (i == 1) bytes += encodeDfrChunk(dfrType("MARK"), "something of a later version");
      if (i == 2) bytes += encodeDfrMeta({{"file sprites/ship.txt", "1234"}});
    }
    bytes += encodeDfrDone("is over");
    done_at = bytes.size();
  }
  std::size_t recordsBefore(std::size_t place) const {
    std::size_t count = 0;
    for (const auto& [end, records] : records_at) count = end <= place ? records : count;
    return count;
  }
};

/// Step between the file positions tried: 1, or 7 under a sanitizer.
constexpr std::size_t kEachByte = test::kSanitized ? 7 : 1;

std::size_t countRecords(DfrReader& reader) {
  std::size_t count = 0;
  while (reader.next()) ++count;
  return count;
}

TEST(DfrTest, WrittenFileIsReadBackUnchanged) {
  const SmallFile file;
  DfrReader reader(file.bytes);
  ASSERT_EQ(reader.problem(), "");
  EXPECT_EQ(reader.header().seed, 42u);
  EXPECT_EQ(reader.header().frame_nanos, 33'333'333u);
  EXPECT_EQ(reader.header().start_nanos, 1'700'000'000'000'000'000u);
  EXPECT_EQ(reader.header().uuid[2], 3);
  EXPECT_EQ(reader.facts().at("game"), "hello");
  SplitMix64 random(5);
  for (int i = 0; i < 30; ++i) {
    const WorldTurn wanted = randomTurn(random);
    const auto turn = reader.next();
    ASSERT_TRUE(turn && std::holds_alternative<WorldTurn>(*turn)) << i;
    std::string a;
    std::string b;
    TurnRecordWriter().write(wanted, a);
    TurnRecordWriter().write(std::get<WorldTurn>(*turn), b);
    EXPECT_EQ(a, b) << i;
    const auto result = reader.next();
    ASSERT_TRUE(result && std::holds_alternative<TickResult>(*result)) << i;
    EXPECT_EQ(std::get<TickResult>(*result).check, static_cast<std::uint8_t>(random.next()));
    if (i % 5 == 2) {
      EXPECT_EQ(std::get<TickResult>(*result).state_hash, random.next());
    }
  }
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.end(), DfrEnd::kDone);
  EXPECT_EQ(reader.endReason(), "is over");
  EXPECT_EQ(reader.facts().at("file sprites/ship.txt"), "1234");
}

TEST(DfrTest, FactsBeyondOneChunkAreDropped) {
  DfrFacts facts;
  for (int i = 0; i < 100; ++i) facts["fact " + std::to_string(i)] = std::string(2 * kMaxDfrValue, 'x');
  const std::string bytes = encodeDfrHeader(DfrHeader()) + encodeDfrMeta(facts);
  DfrReader reader(bytes);
  reader.skipToEnd();
  EXPECT_EQ(reader.problem(), "");
  EXPECT_EQ(reader.wholeBytes(), bytes.size());
  EXPECT_GT(reader.facts().size(), 60u);
  EXPECT_LT(reader.facts().size(), 65u);
}

TEST(DfrTest, PictureIsReadBackUnchanged) {
  RecordedPicture picture{7, df::Canvas(80, 24)};
  picture.canvas.put(3, 4, {U'█', df::GREEN});
  std::string records;
  TurnRecordWriter().write(picture, records);
  TurnRecordReader reader;
  reader.add(records);
  const auto read = reader.next();
  ASSERT_TRUE(read && std::holds_alternative<RecordedPicture>(*read));
  EXPECT_EQ(std::get<RecordedPicture>(*read).player, 7u);
  EXPECT_EQ(countDifferences(std::get<RecordedPicture>(*read).canvas, picture.canvas), 0);
}

TEST(DfrTest, TruncatedFileIsReadableUpToLastWholeRecord) {
  const SmallFile file;
  for (std::size_t size = 0; size <= file.bytes.size(); size += kEachByte) {
    DfrReader reader(std::string_view(file.bytes).substr(0, size));
    if (size < kDfrHeaderSize) {
      EXPECT_NE(reader.problem(), "") << size;
      EXPECT_FALSE(reader.next());
      continue;
    }
    ASSERT_EQ(reader.problem(), "") << size;
    EXPECT_EQ(countRecords(reader), file.recordsBefore(size)) << size;
    EXPECT_EQ(reader.end(), size < file.done_at ? DfrEnd::kTorn : DfrEnd::kDone) << size;
  }
}

TEST(DfrTest, SkippingToTheEndGetsAsFarAsReading) {
  const auto expect_same = [](std::string_view bytes, std::size_t at) {
    DfrReader reader(bytes);
    countRecords(reader);
    DfrReader skipped(bytes);
    skipped.skipToEnd();
    EXPECT_EQ(skipped.end(), reader.end()) << at;
    EXPECT_EQ(skipped.wholeBytes(), reader.wholeBytes()) << at;
    EXPECT_EQ(skipped.streamBytes(), reader.streamBytes()) << at;
    EXPECT_FALSE(skipped.next()) << at;
  };
  const SmallFile file;
  for (std::size_t at = 0; at <= file.bytes.size(); at += kEachByte) {
    expect_same(std::string_view(file.bytes).substr(0, at), at);
    std::string changed = file.bytes + '\0';
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    expect_same(changed, at);
  }
}

TEST(DfrTest, UnwrittenBlocksReadAsATruncatedFile) {
  const SmallFile file;
  const std::string bytes = file.bytes.substr(0, file.records_at[2].first) + std::string(4096, '\0');
  DfrReader zeros(bytes);
  EXPECT_EQ(countRecords(zeros), file.records_at[2].second);
  EXPECT_EQ(zeros.end(), DfrEnd::kTorn);
}

TEST(DfrTest, ChangedByteStopsReadingAtItsChunk) {
  const SmallFile file(3);
  const std::size_t all = file.records_at.back().second;
  for (std::size_t at = 0; at < file.bytes.size(); at += kEachByte) {
    std::string changed = file.bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    DfrReader reader(changed);
    const std::size_t count = countRecords(reader);
    const bool is_flag = at == kDfrFlagsAt || at == kDfrFlagsAt + 1;  // the flags change while a round is
                                                                      // written
    if (is_flag) {
      EXPECT_EQ(count, all);
      continue;
    }
    EXPECT_EQ(count, at < kDfrHeaderSize ? 0 : file.recordsBefore(at)) << at;
    EXPECT_NE(reader.end(), DfrEnd::kDone) << at;
  }
}

TEST(DfrTest, OtherVersionsAndFormatsAreRefused) {
  std::string bytes = SmallFile().bytes;
  bytes[8] = 1;
  EXPECT_EQ(DfrReader(bytes).problem(), "format version 1, but this program reads version 2");
  EXPECT_EQ(DfrReader("#!/bin/sh\n").problem(), "not a round recording");
}

TEST(DfrTest, RecordsBeyondOneChunkAreReadBack) {
  std::string records;
  TurnRecordWriter writer;
  WorldTurn turn;
  SplitMix64 random(1);
  std::size_t count = 0;
  for (; records.size() < kMaxDfrPayload + kMaxDfrPayload / 4; ++count) {
    turn.inputs.assign(100, {df::InputQueue::kMouse, static_cast<std::uint32_t>(random.next())});
    for (auto& input : turn.inputs) {
      input.mouse_action = df::CLICKED;
      input.button = df::Mouse::LEFT;
      input.x = static_cast<int>(random.below(80));
    }
    writer.write(turn, records);
  }
  DfrTurnPacker packer;
  const std::string bytes = encodeDfrHeader({}) + packer.pack(records);
  DfrReader reader(bytes);
  EXPECT_EQ(countRecords(reader), count);
  EXPECT_EQ(reader.end(), DfrEnd::kTorn);
}

TEST(DfrTest, UnknownRecordsAreSkipped) {
  std::string records;
  TurnRecordWriter writer;
  writer.write(WorldTurn(), records);
  records += "\4cabc";  // record of kind 99, 'c'
  writer.write(TickResult(), records);
  TurnRecordReader reader;
  reader.add(records);
  EXPECT_TRUE(std::holds_alternative<WorldTurn>(*reader.next()));
  EXPECT_TRUE(std::holds_alternative<TickResult>(*reader.next()));
  EXPECT_FALSE(reader.next());
  EXPECT_TRUE(reader.atEnd());
  EXPECT_FALSE(reader.isBad());
}

TEST(DfrTest, ChunkWithOversizedLengthIsDamaged) {
  std::string bytes = SmallFile(1).bytes;
  storeLittleEndian(static_cast<std::uint32_t>(kMaxDfrPayload + 1), bytes.data() + kDfrHeaderSize + 4);
  DfrReader reader(bytes);
  EXPECT_FALSE(reader.next());
  EXPECT_EQ(reader.end(), DfrEnd::kDamaged);
}

// Repetition packs to almost nothing: such a file could cost as much memory as one a thousand times its size.
TEST(DfrTest, DecompressionBombIsReportedAsDamaged) {
  DfrTurnPacker packer;
  std::string records;
  for (int i = 0; i < 100'000; ++i) records += "\4caaa";
  std::string bytes = encodeDfrHeader({});
  for (int i = 0; i < 6; ++i) bytes += packer.pack(records);
  ASSERT_LT(bytes.size(), 20'000u);
  DfrReader reader(bytes);
  EXPECT_EQ(countRecords(reader), 0u);
  EXPECT_EQ(reader.end(), DfrEnd::kDamaged);
}

TEST(RecordCoder, PackedPiecesUnpackToTheSameBytes) {
  SplitMix64 random(3);
  RecordPacker packer;
  RecordUnpacker unpacker;
  for (std::uint64_t i = 0; i < 300; ++i) {
    std::string bytes(random.below(200), '\0');
    for (char& byte : bytes) byte = static_cast<char>(random.below(i % 3 == 0 ? 256 : 1 + i % 5));
    std::string packed;
    std::string back;
    packer.pack(bytes, packed);
    unpacker.unpack(packed, bytes.size(), back);
    ASSERT_EQ(back, bytes) << i;
    ASSERT_LE(packed.size(), bytes.size() + bytes.size() / 4 + 8);
  }
}

// The bytes must not change, because other machines and later versions read the files.
TEST(RecordCoder, PackedFormatIsUnchanged) {
  std::string records;
  TurnRecordWriter writer;
  SplitMix64 random(11);
  for (int i = 0; i < 200; ++i) writer.write(randomTurn(random), records);
  std::string packed;
  RecordPacker().pack(records, packed);
  EXPECT_EQ(crc32c(records), 368131252u);
  EXPECT_EQ(packed.size(), 557u);
  EXPECT_EQ(crc32c(packed), 248523405u);
}

TEST(DfrTest, TheChecksumIsCrc32c) {
  EXPECT_EQ(crc32c("123456789"), 0xe3069283u);  // RFC 3720, B.4
  EXPECT_EQ(crc32c("6789", crc32c("12345")), 0xe3069283u);
}

}  // namespace
}  // namespace naiad
