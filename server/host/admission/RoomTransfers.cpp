#include "host/admission/RoomTransfers.h"

#include <algorithm>
#include <utility>

#include "host/rooms/SessionTable.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/program/LogText.h"

namespace naiad {

void RoomTransfers::ask(const Session& session, const std::string& room) {
  std::erase_if(m_requests, [&session](const Request& request) { return request.session == session.id(); });
  m_requests.push_back({session.id(), room.substr(0, kMaxRoomName + 1)});
}

void RoomTransfers::askByGame(Session& session, const std::string& room) {
  session.admitRoomRequest() ? ask(session, room)
                             : static_cast<void>(++m_context.counters.room_requests_dropped);
}

void RoomTransfers::evacuate(const Room& room, const std::string& sentence) {
  if (&room == &m_rooms.firstRoom()) return room.disconnectAll(sentence);
  room.broadcast(sentence);
  room.forEachPlaying([&](Session& session) {
    ask(session, m_rooms.firstRoom().plan()->name);
    m_requests.back().goodbye_message = sentence;
  });
}

void RoomTransfers::update() {
  for (const Request& request : std::exchange(m_requests, {})) grant(request);
}

void RoomTransfers::grant(const Request& request) {
  Session* const p_session = m_sessions.find(request.session);
  if (p_session == nullptr || p_session->state() != Session::State::kPlaying) return;
  const Room* const p_from = m_rooms.roomOf(*p_session);
  if (p_from != nullptr && p_from->plan() != nullptr && p_from->plan()->name == request.room) return;
  const std::string refusal =
      m_admission.moveSession(*p_session, request.room, !request.goodbye_message.empty());
  if (!refusal.empty()) return refuse(*p_session, request, refusal);
  ++m_context.counters.room_transfers;
  m_context.client_log.logClientEvent(p_session->address(),
                                      {"moved",
                                       inQuotes(p_session->name()) + " moved to the room " + request.room,
                                       {{"player", p_session->name()}, {"room", request.room}}},
                                      p_session->now());
}

void RoomTransfers::refuse(Session& session, const Request& request, const std::string& sentence) {
  ++m_context.counters.room_moves_refused;
  if (!request.goodbye_message.empty()) return session.sendGoodbye(request.goodbye_message);
  sendServerLine(session, sentence);
}

void RoomTransfers::sendList(Session& session) const {
  if (!m_rooms.isNamed()) return;
  wire::ServerMessage message;
  wire::RoomList& list = *message.mutable_rooms();
  m_rooms.forEachRoom([&list](const Room& room) {
    wire::RoomEntry& entry = *list.add_rooms();
    entry.set_name(room.plan()->name);
    entry.set_game(safeText(room.plan()->game, kMaxProgramLength));
    entry.set_players(static_cast<std::uint32_t>(room.countPlaying()));
    entry.set_max_players(static_cast<std::uint32_t>(room.plan()->max_players));
    entry.set_asleep(room.isAsleep());
  });
  session.sendBestEffort(message);
}

}  // namespace naiad
