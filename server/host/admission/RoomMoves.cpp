#include "host/admission/RoomMoves.h"

#include <algorithm>
#include <utility>

#include "host/rooms/SessionTable.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/program/LogText.h"

namespace naiad {

void RoomMoves::ask(const Session& session, const std::string& room) {
  std::erase_if(m_wishes, [&session](const Wish& wish) { return wish.session == session.id(); });
  m_wishes.push_back({session.id(), room.substr(0, kMaxRoomName + 1)});
}

void RoomMoves::askByGame(Session& session, const std::string& room) {
  session.admitRoomRequest() ? ask(session, room)
                             : static_cast<void>(++m_context.counters.room_requests_dropped);
}

void RoomMoves::leadAway(const Room& room, const std::string& sentence) {
  if (&room == &m_rooms.firstRoom()) return room.dismiss(sentence);
  room.say(sentence);
  room.forEachPlaying([&](Session& session) {
    ask(session, m_rooms.firstRoom().plan()->name);
    m_wishes.back().or_goodbye = sentence;
  });
}

void RoomMoves::update() {
  for (const Wish& wish : std::exchange(m_wishes, {})) grant(wish);
}

void RoomMoves::grant(const Wish& wish) {
  Session* const p_session = m_sessions.find(wish.session);
  if (p_session == nullptr || p_session->state() != Session::State::kPlaying) return;
  const Room* const p_from = m_rooms.roomOf(*p_session);
  if (p_from != nullptr && p_from->plan() != nullptr && p_from->plan()->name == wish.room) return;
  const std::string refusal = m_admission.moveSession(*p_session, wish.room, !wish.or_goodbye.empty());
  if (!refusal.empty()) return refuse(*p_session, wish, refusal);
  ++m_context.counters.room_moves;
  m_context.client_log.logNews(p_session->address(),
                               {"moved",
                                inQuotes(p_session->name()) + " moved to the room " + wish.room,
                                {{"player", p_session->name()}, {"room", wish.room}}},
                               p_session->now());
}

void RoomMoves::refuse(Session& session, const Wish& wish, const std::string& sentence) {
  ++m_context.counters.room_moves_refused;
  if (!wish.or_goodbye.empty()) return session.goodbye(wish.or_goodbye);
  sendServerLine(session, sentence);
}

void RoomMoves::sendList(Session& session) const {
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
  session.sendFleeting(message);
}

}  // namespace naiad
