// The round of a killed server, read from its file by the server that resumes it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/journal/DfrReader.h"
#include "host/world/TurnRecord.h"

namespace naiad {

/// Error of a round that cannot be resumed. what() says why, like "its format is version 2, …".
class UnfinishedRoundError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class UnfinishedRound {
 public:
  /// Reads the whole file. Throws UnfinishedRoundError. A round that has ended is not an error: see isOver().
  explicit UnfinishedRound(std::string path);
  /// Reads a round that is in this process's memory. `records`: all of them, from the beginning.
  UnfinishedRound(const DfrHeader& header, std::string_view records);

  const std::string& path() const { return m_path; }
  const DfrHeader& header() const { return m_header; }
  const DfrFacts& facts() const { return m_facts; }
  /// Returns a fact; empty if the file does not have it.
  std::string fact(const std::string& name) const { return factOf(m_facts, name); }
  bool isOver() const { return m_over; }

  /// Returns the number of bytes up to the end of the file's last chunk that ends with a whole record.
  std::size_t wholeBytes() const { return m_whole_bytes; }
  /// Returns the record stream, unpacked (TurnRecordReader).
  const std::string& records() const { return m_records; }
  /// True if the file has the result of the last turn.
  bool hasLastResult() const { return m_has_last_result; }
  /// Returns the number of turns that the world got.
  std::uint32_t turns() const { return m_turns; }
  /// Returns the newest turn, without its inputs.
  const WorldTurn& lastTurn() const { return m_last_turn; }
  /// Returns the sessions of players that had not left, by player.
  const std::map<std::uint32_t, PersistedSession>& sessions() const { return m_sessions; }
  /// Returns the players in the world, in the order in which they joined.
  const std::vector<std::uint32_t>& players() const { return m_players; }
  /// Returns the highest player id in the round; 0 without players. A world never uses an id twice.
  std::uint32_t highestPlayer() const { return m_highest_player; }
  /// Returns when the file was last written.
  std::filesystem::file_time_type writtenAt() const { return m_written_at; }
  /// Removes all sessions: their players are no longer waited for.
  void dropSessions() { m_sessions.clear(); }
  /// Returns inputs that bring the world to the state just after all players were disconnected: held keys are
  /// released, players without a session leave, players with a session who had not joined yet join, and all
  /// rooms of the server are closed until it reports them again (GameRooms.h).
  std::vector<df::InputQueue::Input> closingInputs() const;

  /// Returns the state for appending to the journal. May be called once.
  JournalPosition releasePosition() { return std::move(*std::exchange(m_position, nullptr)); }

 private:
  UnfinishedRound() = default;
  void readAll(std::string_view bytes);
  void recordTurn(const WorldTurn& turn);
  void recordInput(const df::InputQueue::Input& input);
  void recordSession(const PersistedSession& session);

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
  std::map<std::uint32_t, PersistedSession> m_sessions;
  std::vector<std::uint32_t> m_players;
  std::uint32_t m_highest_player = 0;
  std::set<std::pair<std::uint32_t, int>> m_held_keys;  ///< held keys, by player
  std::map<std::string, df::GameRoom> m_rooms;          ///< rooms that the world knows, by name
  std::unique_ptr<JournalPosition> m_position;
};

}  // namespace naiad
