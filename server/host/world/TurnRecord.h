// What goes into a world and what comes of it, as its process gets it and its journal keeps it: a stream of
// records, each a length and its fields.
//
//   record  size of the rest (varint) | kind (1) | fields
//
// A turn is what the world is sent before a tick, an answer what came of it. Records of unknown kinds are
// skipped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/world/InputQueue.h"
#include "host/world/WorldMessages.h"
#include "shared/values/Canvas.h"
#include "shared/values/Color.h"

namespace naiad {

/// What a journal keeps of a player's session, so that the player comes back after the server was killed.
/// Of a token, only its SHA-256 is kept (ResumeTokens.h). No address, no rights of an admin.
struct KeptSession {
  std::uint32_t player = 0;
  bool over = false;  ///< the player has left; the fields below say nothing
  bool muted = false;
  std::string name = {};  ///< kMaxKeptName bytes at most
  df::Color color = df::COLOR_DEFAULT;
  std::string newest = {};    ///< hash of the token that was issued last; empty: there is none
  std::string redeemed = {};  ///< hash of the one before, if it is still good
};
inline constexpr std::size_t kMaxKeptName = 256;
inline constexpr std::size_t kKeptHash = 32;  ///< bytes

/// Inputs, and a tick.
struct WorldTurn {
  std::vector<df::InputQueue::Input> inputs;  ///< in the order they came
  bool watched = false;                       ///< the answer is to have a view
  bool wants_truth = false;                   ///< and pictures
  bool ends_game = false;
  bool checked = false;            ///< the answer is to have a hash of the state
  std::uint32_t heard_player = 0;  ///< only their input comes; 0: all players' does
  std::uint32_t pictured = 0;      ///< only their picture is wanted; 0: all players' are
};

/// A turn as a world is sent it.
struct SentTurn {
  WorldTurn turn;
  std::string record;  ///< the same bytes that the journal stores; empty: the turn is too long for a record
};

/// The keys and clicks that wait for a world (Round::kMaxInputs), joins, leaves and scores.
inline constexpr std::size_t kMaxTurnInputs = std::size_t{1} << 16;

/// How the tick of the last turn ended.
struct TickResult {
  std::uint8_t check = 0;  ///< eight bits of WorldAnswer::hash; 0 if there is none
  bool has_check = false;
  bool game_over = false;
  std::optional<std::uint64_t> state_hash;  ///< df::hashState()
};

/// What a player saw after the last turn.
struct RecordedPicture {
  std::uint32_t player = 0;
  df::Canvas canvas;
};

/// The world ended in the last turn, and another one had it without its keys and clicks.
struct InputsDropped {};
/// Joins and leaves stay.
void dropKeys(WorldTurn& turn);

using TurnRecord = std::variant<WorldTurn, TickResult, RecordedPicture, KeptSession, InputsDropped>;

/// Eight bits of a hash of an answer.
std::uint8_t checkOf(std::uint64_t answer_hash);

/// Spells records. Turns are spelled by what is other than in the turn before.
class TurnRecordWriter {
 public:
  TurnRecordWriter() = default;
  /// Goes on with a stream whose last turn was this.
  explicit TurnRecordWriter(const WorldTurn& last);
  /// Append one to `out`. False, and nothing is appended: more than kMaxTurnInputs.
  bool write(const WorldTurn& turn, std::string& out);
  /// The next turn says all its flags, whatever the one before had: what begins with it can be read alone.
  void repeatFlags() { m_repeats_flags = true; }
  void write(const TickResult& result, std::string& out);
  void write(const RecordedPicture& picture, std::string& out);
  void write(const KeptSession& session, std::string& out);
  void write(const InputsDropped& dropped, std::string& out);

 private:
  void append(std::string& out);

  WorldTurn m_last;  ///< without inputs
  bool m_repeats_flags = false;
  std::string m_fields;
};

/// Bytes of a record without its length, at most: a whole turn, or a picture.
inline constexpr std::size_t kMaxTurnRecord = std::size_t{8} << 20;

/// Reads a stream of them, which may come in pieces.
class TurnRecordReader {
 public:
  /// The next bytes of the stream.
  void add(std::string_view bytes) { m_bytes.append(bytes); }
  /// The next record; nothing if there is no whole one left, or isBad().
  std::optional<TurnRecord> next();
  /// Something was malformed; nothing can be read any more.
  bool isBad() const { return m_bad; }
  /// All that was added has been read.
  bool atEnd() const { return m_at == m_bytes.size(); }

 private:
  std::optional<TurnRecord> read(std::string_view record);
  std::optional<TurnRecord> readTurn(FieldReader& in, std::uint8_t kind);

  std::string m_bytes;
  std::size_t m_at = 0;
  WorldTurn m_last;
  bool m_bad = false;
};

/// A message to a world's process, appended to `out`: a turn's record, whether a copy is to be made behind it
/// (WorldCopies.h), and tick.
void appendTurnMessage(std::string_view record, bool copied, std::string& out);
/// Its fields, by the reader that has had those of all turns before. Nothing: it is malformed.
std::optional<WorldTurn> readTurnMessage(std::string_view fields, TurnRecordReader& records, bool& copied);

}  // namespace naiad
