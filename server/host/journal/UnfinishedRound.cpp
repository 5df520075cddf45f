#include "host/journal/UnfinishedRound.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "host/journal/JournalSink.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

using Input = df::InputQueue::Input;

std::string bytesOf(const std::string& path) {
  try {
    if (auto bytes = readTrusted(path, kMaxRoundFile)) return *std::move(bytes);
  } catch (const std::system_error& error) {
    throw UnfinishedRoundError(error.what());
  }
  throw UnfinishedRoundError("no such file");
}

}  // namespace

UnfinishedRound::UnfinishedRound(std::string path) {
  std::error_code ignored;
  const auto written_at = std::filesystem::last_write_time(path, ignored);
  readAll(bytesOf(path));
  m_path = std::move(path);
  m_written_at = written_at;
}

UnfinishedRound::UnfinishedRound(const DfrHeader& header, std::string_view records) {
  readAll(encodeDfrHeader(header) + encodeDfrTurns(records, 0));
}

// A file may end in the middle of a record, whose rest was in the next chunk. The journal then continues
// after the last chunk that ends with a whole record.
void UnfinishedRound::readAll(std::string_view bytes) {
  DfrReader reader(bytes);
  if (!reader.problem().empty()) throw UnfinishedRoundError(reader.problem());
  m_header = reader.header();
  reader.copyRecordsTo(m_records);
  while (const auto record = reader.next()) {
    if (const auto* p_turn = std::get_if<WorldTurn>(&*record)) recordTurn(*p_turn);
    m_has_last_result = std::holds_alternative<TickResult>(*record) ||
                        (m_has_last_result && !std::holds_alternative<WorldTurn>(*record));
    if (const auto* p_session = std::get_if<PersistedSession>(&*record)) recordSession(*p_session);
  }
  m_whole_bytes = reader.bytesOfWholeRecords();
  m_facts = reader.facts();
  m_over = reader.end() == DfrEnd::kDone;
  if (m_over || m_whole_bytes == reader.wholeBytes()) {
    m_position = std::make_unique<JournalPosition>(reader.releasePosition());
    return;
  }
  const std::string_view whole = bytes.substr(0, m_whole_bytes);
  *this = UnfinishedRound();
  readAll(whole);
}

void UnfinishedRound::recordTurn(const WorldTurn& turn) {
  ++m_turns;
  for (const Input& input : turn.inputs) recordInput(input);
  m_last_turn = turn;
  m_last_turn.inputs.clear();
}

void UnfinishedRound::recordInput(const Input& input) {
  switch (input.kind) {
    case df::InputQueue::kJoin:
      m_players.push_back(input.player);
      m_highest_player = std::max(m_highest_player, input.player);
      break;
    case df::InputQueue::kLeave:
      std::erase(m_players, input.player);
      m_sessions.erase(input.player);  // only a player whose session is over, or not waited for, leaves
      std::erase_if(m_held_keys, [&input](const auto& one) { return one.first == input.player; });
      break;
    case df::InputQueue::kKey:
      if (input.key_action == df::KEY_RELEASED) {
        m_held_keys.erase({input.player, input.key});
      } else {
        m_held_keys.insert({input.player, input.key});
      }
      break;
    case df::InputQueue::kRoom:
      m_rooms[input.room.name] = input.room;
      break;
    case df::InputQueue::kMouse:
    case df::InputQueue::kScore:
      break;
  }
}

void UnfinishedRound::recordSession(const PersistedSession& session) {
  if (session.over) {
    m_sessions.erase(session.player);
  } else {
    m_sessions[session.player] = session;
    m_highest_player = std::max(m_highest_player, session.player);
  }
}

std::vector<Input> UnfinishedRound::closingInputs() const {
  std::vector<Input> inputs;
  for (const auto& [player, key] : m_held_keys) {
    Input release{.kind = df::InputQueue::kKey, .player = player};
    release.key = static_cast<df::Keyboard::Key>(key);
    release.key_action = df::KEY_RELEASED;
    inputs.push_back(release);
  }
  for (const std::uint32_t player : m_players) {
    if (!m_sessions.contains(player)) inputs.push_back({.kind = df::InputQueue::kLeave, .player = player});
  }
  for (const auto& [player, session] : m_sessions) {
    if (std::find(m_players.begin(), m_players.end(), player) != m_players.end()) continue;
    inputs.push_back(
        {.kind = df::InputQueue::kJoin, .player = player, .name = session.name, .color = session.color});
  }
  for (auto [name, room] : m_rooms) {
    room.players = room.max_players = 0;
    inputs.push_back({.kind = df::InputQueue::kRoom, .player = 0, .room = std::move(room)});
  }
  return inputs;
}

}  // namespace naiad
