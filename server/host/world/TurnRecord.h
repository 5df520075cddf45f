// The inputs and results of a world as a stream of records. The world's process gets the turns, and the
// journal stores the whole stream.
//
//   record  size of the rest (varint) | kind (1) | fields
//
// A turn is sent to the world before a tick; a result says how the tick ended. Readers skip unknown kinds.
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

/// A player's session in the journal, so that the player can reconnect after the server was killed. Of each
/// token only the SHA-256 is stored (ResumeTokens.h). Addresses and rights of admins are not stored.
struct PersistedSession {
  std::uint32_t player = 0;
  bool over = false;  ///< the player has left; the fields below are unused
  bool muted = false;
  std::string name = {};  ///< at most kMaxPersistedName bytes
  df::Color color = df::COLOR_DEFAULT;
  std::string newest = {};    ///< hash of the token issued last; empty: none
  std::string redeemed = {};  ///< hash of the previous token, if that is still valid; else empty
};
inline constexpr std::size_t kMaxPersistedName = 256;
inline constexpr std::size_t kPersistedHashSize = 32;  ///< bytes of a token's hash

/// The inputs of a tick, and the parts that its answer must have.
struct WorldTurn {
  std::vector<df::InputQueue::Input> inputs;  ///< ordered by arrival
  bool watched = false;                       ///< the answer must have a view
  bool wants_truth = false;                   ///< the answer of a watched turn must have pictures
  bool ends_game = false;
  bool checked = false;               ///< the answer must have a hash of the state
  std::uint32_t input_player = 0;     ///< the only player whose input is passed on; 0: all
  std::uint32_t rendered_player = 0;  ///< only this player's picture is rendered; 0: all players'
};

/// A turn as it is sent to a world.
struct SentTurn {
  WorldTurn turn;
  std::string record;  ///< its record, as in the journal; empty if it has too many inputs
};

/// Maximum inputs of a turn: waiting keys and clicks (Round::kMaxInputs), joins, leaves, scores and rooms.
inline constexpr std::size_t kMaxTurnInputs = std::size_t{1} << 16;

/// Result of the last turn's tick.
struct TickResult {
  std::uint8_t check = 0;  ///< eight bits of WorldAnswer::hash; 0 without has_check
  bool has_check = false;
  bool game_over = false;
  std::optional<std::uint64_t> state_hash;  ///< df::hashState()
};

/// A player's picture after the last turn.
struct RecordedPicture {
  std::uint32_t player = 0;
  df::Canvas canvas;
};

/// Marks a crash or hang in the last turn. The successor of the world got that turn without keys and clicks.
struct InputsDropped {};
/// Removes keys and clicks from a turn. Joins and leaves stay.
void dropKeys(WorldTurn& turn);

using TurnRecord = std::variant<WorldTurn, TickResult, RecordedPicture, PersistedSession, InputsDropped>;

/// Returns the highest eight bits of an answer's hash.
std::uint8_t checkOf(std::uint64_t answer_hash);

/// Encodes records. The flags of a turn are written only if they differ from those of the previous turn.
class TurnRecordWriter {
 public:
  TurnRecordWriter() = default;
  /// Continues a stream whose last turn was `last`.
  explicit TurnRecordWriter(const WorldTurn& last);
  /// Appends a turn to `out`. Returns false, and appends nothing, if it has more than kMaxTurnInputs inputs.
  bool write(const WorldTurn& turn, std::string& out);
  /// Makes the writer write all flags of the next turn, so that the stream can be read from there.
  void repeatFlags() { m_repeats_flags = true; }
  void write(const TickResult& result, std::string& out);
  void write(const RecordedPicture& picture, std::string& out);
  void write(const PersistedSession& session, std::string& out);
  void write(const InputsDropped& dropped, std::string& out);

 private:
  void append(std::string& out);

  WorldTurn m_last;  ///< without inputs
  bool m_repeats_flags = false;
  std::string m_fields;
};

/// Maximum bytes of a record without its length: a whole turn, or a picture.
inline constexpr std::size_t kMaxTurnRecord = std::size_t{8} << 20;

/// Reads a stream of records, which may arrive in pieces.
class TurnRecordReader {
 public:
  /// Adds the next bytes of the stream.
  void add(std::string_view bytes) { m_bytes.append(bytes); }
  /// Returns the next record; nullopt if none is complete, or isBad().
  std::optional<TurnRecord> next();
  /// True if a record was malformed; then nothing more can be read.
  bool isBad() const { return m_bad; }
  /// True if all bytes that were added have been read.
  bool atEnd() const { return m_at == m_bytes.size(); }

 private:
  std::optional<TurnRecord> read(std::string_view record);
  std::optional<TurnRecord> readTurn(FieldReader& in, std::uint8_t kind);

  std::string m_bytes;
  std::size_t m_at = 0;
  WorldTurn m_last;
  bool m_bad = false;
};

/// Appends to `out` a message for a world's process: a turn's record, and whether a copy is to be made after
/// the turn's tick (WorldCheckpoints.h).
void appendTurnMessage(std::string_view record, bool copied, std::string& out);
/// Reads the fields of a message of appendTurnMessage(). Call for all turns in order. Returns nullopt if the
/// fields are malformed.
std::optional<WorldTurn> readTurnMessage(std::string_view fields, TurnRecordReader& records, bool& copied);

}  // namespace naiad
