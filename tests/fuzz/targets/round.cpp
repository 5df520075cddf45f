// The file of a round, which a stranger may have made.
//
//   input   0 a file as it is; 1 chunks: each: type (1) | length (2) | payload | …; 2 records of a
//           TURN chunk (1) | bytes
//
// In 1 and 2 the checksums are right, because a stranger can compute them, too.
#include "Target.h"
#include "host/journal/DfrReader.h"
#include "host/journal/DfrWriter.h"
#include "shared/replica/Bytes.h"

namespace naiad::fuzz {
namespace {

/// Requires that the turn is equal after being written and read again.
void tryAgain(const WorldTurn& turn) {
  std::string first;
  std::string second;
  REQUIRE(TurnRecordWriter().write(turn, first));
  TurnRecordReader reader;
  reader.add(first);
  const auto record = reader.next();
  REQUIRE(record && std::holds_alternative<WorldTurn>(*record) && reader.atEnd());
  REQUIRE(TurnRecordWriter().write(std::get<WorldTurn>(*record), second));
  REQUIRE(first == second);
}

void tryFile(std::string_view bytes) {
  const Exactly file(bytes);
  DfrReader reader(file.view());
  std::size_t records = 0;
  while (const auto record = reader.next()) {
    REQUIRE(reader.problem().empty());
    // A record has at least two bytes, and no file unpacks to more than 64 times its size.
    REQUIRE(++records <= (64 * bytes.size() + kMaxDfrPayload) / 2);
    if (const auto* p_turn = std::get_if<WorldTurn>(&*record)) tryAgain(*p_turn);
    if (const auto* p_picture = std::get_if<RecordedPicture>(&*record))
      REQUIRE(p_picture->canvas.width() <= 400 && p_picture->canvas.height() <= 150);
  }
  REQUIRE(!reader.next());
  REQUIRE(reader.facts().size() <= kMaxDfrFacts);
  REQUIRE(reader.end() == DfrEnd::kDone || reader.endReason().empty());
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

}  // namespace

void tryInput(Script script) {
  switch (script.below(3)) {
    case 0:
      tryFile(script.rest());
      break;
    case 1:
      tryFile(chunksOf(script));
      break;
    default:
      tryFile(turnsOf(script));
      break;
  }
}

}  // namespace naiad::fuzz
