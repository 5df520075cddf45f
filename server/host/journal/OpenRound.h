// The round of a server that was killed: what its file says, for the server that goes on with it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/world/TurnRecord.h"

namespace naiad {

/// A round that nothing can go on from. what() says why, like "its format is version 2, …".
class OpenRoundError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class OpenRound {
 public:
  /// Reads the whole file. Throws OpenRoundError. One that has come to its end is no error: isOver().
  explicit OpenRound(std::string path);
  /// The same of a round that this process has in memory: its records from the beginning.
  OpenRound(const DfrHeader& header, std::string_view records);

  const std::string& path() const { return m_path; }
  const DfrHeader& header() const { return m_header; }
  const DfrFacts& facts() const { return m_facts; }
  /// A fact; empty if the file does not have it.
  std::string fact(const std::string& name) const;
  bool isOver() const { return m_over; }

  /// Bytes of the file up to the end of its last whole record.
  std::size_t wholeBytes() const { return m_whole_bytes; }
  /// Its stream of records, unpacked (TurnRecordReader).
  const std::string& records() const { return m_records; }
  /// The file says what came of the last turn.
  bool hasLastResult() const { return m_has_last_result; }
  /// Turns that the world got.
  std::uint32_t turns() const { return m_turns; }
  /// The newest turn, without its inputs.
  const WorldTurn& lastTurn() const { return m_last_turn; }
  /// Of the players who had not left, by player.
  const std::map<std::uint32_t, KeptSession>& sessions() const { return m_sessions; }
  /// Of the players whom the world has, in the order in which they joined.
  const std::vector<std::uint32_t>& players() const { return m_players; }
  /// The highest id that any of its players ever had; 0 without players. The world does not use an id twice.
  std::uint32_t highestPlayer() const { return m_highest_player; }
  /// When the file was written last.
  std::filesystem::file_time_type writtenAt() const { return m_written_at; }
  /// Its players are not waited for any more.
  void dropSessions() { m_sessions.clear(); }
  /// Inputs that bring the world to where its players have just been cut off: keys that were down are
  /// released; a player without a session leaves, and one of whom the world has not heard joins.
  std::vector<df::InputQueue::Input> closingInputs() const;

  /// Where its journal goes on. Once.
  JournalPlace takePlace() { return std::move(*std::exchange(m_place, std::nullopt)); }

 private:
  void readAll(std::string_view bytes);
  void noteTurn(const WorldTurn& turn);
  void noteInput(const df::InputQueue::Input& input);
  void noteSession(const KeptSession& session);

  std::string m_path;
  std::size_t m_whole_bytes = 0;
  std::string m_records;
  bool m_has_last_result = false;
  DfrHeader m_header;
  DfrFacts m_facts;
  std::filesystem::file_time_type m_written_at;
  bool m_over = false;
  std::uint32_t m_turns = 0;
  WorldTurn m_last_turn;
  std::map<std::uint32_t, KeptSession> m_sessions;
  std::vector<std::uint32_t> m_players;
  std::uint32_t m_highest_player = 0;
  std::set<std::pair<std::uint32_t, int>> m_down;  ///< keys, by player
  std::optional<JournalPlace> m_place;
};

}  // namespace naiad
