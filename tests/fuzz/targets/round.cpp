// The file of a round, which a stranger may have made.
//
//   input   0 a file as it is; 1 chunks: each: type (1) | length (2) | payload | …; 2 records of a
//           TURN chunk (1) | bytes; 3 a damaged file: bytes cut off at the end (2), changed byte (2),
//           its bits that are flipped (1) | chunks
//
// In 1 and 2 the checksums are right, because a stranger can compute them, too.
#include "Target.h"
#include "host/journal/DfrReader.h"
#include "host/journal/DfrWriter.h"
#include "shared/replica/Bytes.h"

namespace naiad::fuzz {
namespace {

struct Contents {
  std::string stream;   ///< the record stream as it is in the file
  std::string records;  ///< the records that were read, written again
};

/// Writes a record again.
void write(const TurnRecord& record, TurnRecordWriter& writer, std::string& out) {
  if (const auto* p_turn = std::get_if<WorldTurn>(&record)) {
    REQUIRE(writer.write(*p_turn, out));
  } else {
    std::visit([&](const auto& other) { writer.write(other, out); }, record);
  }
}

Contents readAll(DfrReader& reader, std::size_t most) {
  Contents all;
  reader.copyRecordsTo(all.stream);
  TurnRecordWriter writer;
  std::size_t count = 0;
  while (const auto record = reader.next()) {
    REQUIRE(reader.problem().empty());
    REQUIRE(++count <= most);
    if (const auto* p_picture = std::get_if<RecordedPicture>(&*record))
      REQUIRE(p_picture->canvas.width() <= 400 && p_picture->canvas.height() <= 150);
    write(*record, writer, all.records);
  }
  REQUIRE(!reader.next());
  REQUIRE(reader.facts().size() <= kMaxDfrFacts);
  REQUIRE(reader.end() == DfrEnd::kDone || reader.endReason().empty());
  return all;
}

/// Requires that a file with the same contents, packed or not, reads equally.
void tryAgain(const DfrReader& before, const Contents& expected, std::size_t most) {
  const bool damaged =
      before.end() == DfrEnd::kDamaged;  // then the stream ends somewhere after the bad record
  for (const bool packed : {false, true}) {
    // A packed stream may be so short that the reader rejects its ratio.
    if (packed && expected.stream.size() > kMaxDfrPayload) break;
    std::string file = encodeDfrHeader(before.header()) + encodeDfrMeta(before.facts());
    file += packed ? DfrTurnPacker().pack(expected.stream) : encodeDfrTurns(expected.stream, 0);
    if (before.end() == DfrEnd::kDone) file += encodeDfrDone(before.endReason());
    DfrReader reader(file);
    const Contents again = readAll(reader, most);
    REQUIRE(again.records == expected.records && (damaged || again.stream == expected.stream));
    REQUIRE(reader.facts() == before.facts() && reader.endReason() == before.endReason());
    REQUIRE(damaged || reader.end() == before.end());
  }
}

/// Requires that written records are equal after being read and written again, and that turns are messages to
/// a world.
void tryRecords(const std::string& records) {
  TurnRecordReader reader;
  TurnRecordReader messages;
  reader.add(records);
  TurnRecordWriter writer;
  std::string again;
  while (const auto record = reader.next()) {
    const std::size_t begin = again.size();
    write(*record, writer, again);
    if (!std::holds_alternative<WorldTurn>(*record)) continue;
    std::string message;
    appendTurnMessage(std::string_view(again).substr(begin), true, message);
    bool copied = false;
    REQUIRE(readTurnMessage(std::string_view(message).substr(kWorldFrameHead), messages, copied) && copied);
  }
  REQUIRE(reader.atEnd() && !reader.isBad());
  REQUIRE(again == records);
}

void tryFile(std::string_view bytes) {
  const Exactly file(bytes);
  DfrReader reader(file.view());
  // A record has at least two bytes, and no file unpacks to more than 64 times its size.
  const std::size_t most = (64 * bytes.size() + kMaxDfrPayload) / 2;
  const Contents contents = readAll(reader, most);
  tryRecords(contents.records);
  if (reader.end() != DfrEnd::kDamaged) {
    DfrReader skipped(file.view());
    skipped.skipToEnd();
    REQUIRE(skipped.end() == reader.end() && skipped.wholeBytes() == reader.wholeBytes());
    REQUIRE(skipped.streamBytes() == reader.streamBytes() && skipped.facts() == reader.facts());
  }
  if (reader.problem().empty()) tryAgain(reader, contents, most);
}

std::string chunksOf(Script& script) {
  constexpr std::uint32_t kTypes[] = {kDfrMeta, kDfrTurn, kDfrDone, dfrType("VIEW")};
  std::string bytes = encodeDfrHeader({});
  while (!script.atEnd()) {
    const std::uint32_t type = kTypes[script.below(4)];
    bytes += encodeDfrChunk(type, script.bytes(script.number<std::uint16_t>()));
  }
  return bytes;
}

std::string turnsOf(Script& script) {
  const std::uint64_t packing = script.byte() & 1;
  const std::string records = script.rest();
  std::string payload(kDfrTurnPositionSize, '\0');
  ByteWriter(payload).varint(records.size() * (packing == kDfrModelled ? 4 : 1) << 1 | packing);
  return encodeDfrHeader({}) + encodeDfrChunk(kDfrTurn, payload + records);
}

std::string damaged(Script& script) {
  const std::size_t cut = script.number<std::uint16_t>();
  const std::size_t at = script.number<std::uint16_t>();
  const std::uint8_t flipped = script.byte();
  std::string bytes = chunksOf(script);
  bytes[at % bytes.size()] ^= static_cast<char>(flipped);
  bytes.resize(bytes.size() - cut % bytes.size());
  return bytes;
}

}  // namespace

void tryInput(Script script) {
  switch (script.below(4)) {
    case 0:
      tryFile(script.rest());
      break;
    case 1:
      tryFile(chunksOf(script));
      break;
    case 2:
      tryFile(turnsOf(script));
      break;
    default:
      tryFile(damaged(script));
      break;
  }
}

}  // namespace naiad::fuzz
