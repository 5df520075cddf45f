#include "host/admission/RoomAdmission.h"

#include <utility>

#include "host/settings/RoomOptions.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

std::size_t placesOf(const Room& room) {
  return static_cast<std::size_t>(room.plan()->max_players);
}

bool isFull(const Room& room) {
  return room.countPlaying() >= placesOf(room);
}

std::string named(const Room& room) {
  return "The room \"" + room.plan()->name + "\"";
}

}  // namespace

Room* RoomAdmission::findRoom(const std::string& name, const std::string& game, Refusal& refusal) const {
  Room* p_found = nullptr;
  if (!name.empty()) {
    p_found = m_rooms.findRoom(name);
    if (p_found == nullptr) {
      refusal = {Reason::kUnknown, unknownRoomMessage(name, m_rooms.roomNames()), ""};
    } else if (!game.empty() && p_found->plan()->game != game) {
      refusal = {
          Reason::kGame,
          named(*p_found) + " plays \"" + p_found->plan()->game + "\", not \"" + safeName(game) + "\".", ""};
      p_found = nullptr;
    }
    return p_found;
  }
  if (game.empty()) return &m_rooms.firstRoom();
  m_rooms.forEachRoom([&](Room& room) {
    if (room.plan()->game != game) return;
    const bool is_better = p_found == nullptr || (isFull(*p_found) && !isFull(room)) ||
                           (p_found->isAsleep() && !room.isAsleep() && !isFull(room));
    if (is_better) p_found = &room;
  });
  if (p_found == nullptr)
    refusal = {Reason::kGame, "No room of this server plays \"" + safeName(game) + "\".", ""};
  return p_found;
}

std::optional<RoomAdmission::Refusal> RoomAdmission::open(Room& room, const AddressPrefix& prefix, Time now) {
  const auto is_here = [&room](const Session& session) { return room.find(session.player()) == &session; };
  if (isFull(room) && !m_sessions.makePlace(prefix, placesOf(room), now, is_here)) {
    return Refusal{
        Reason::kFull,
        named(room) + " is full (" + std::to_string(room.plan()->max_players) + " players). Try again later.",
        ""};
  }
  if (const auto percent = room.round().recovering()) {
    return Refusal{
        Reason::kTemporary,
        "The server restarted. " + named(room) + " is being restored: " + std::to_string(*percent) + " %.",
        ""};
  }
  if (!room.isAsleep()) return std::nullopt;
  if (now < room.sleep().closed_until)
    return Refusal{Reason::kTemporary, named(room) + " is closed for a moment: its game failed.", ""};
  if (!m_wakes.tryConsume(prefix, now))
    return Refusal{Reason::kTemporary, "Too many rooms started recently. Try again in a moment.", ""};
  std::string problem;
  if (m_rooms.wake(room, problem)) return std::nullopt;
  return Refusal{Reason::kTemporary, named(room) + " cannot start now. Try again later.", problem};
}

}  // namespace naiad
