// Players who go from one room to another: by their client's wish, a game's, or since their room was closed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/admission/Admission.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"

namespace naiad {

/// Not thread-safe.
class RoomMoves {
 public:
  /// All of these outlive it.
  RoomMoves(HostContext& context, SessionTable& sessions, Rooms& rooms, Admission& admission)
      : m_context(context), m_sessions(sessions), m_rooms(rooms), m_admission(admission) {}

  /// In the next update(). Of several for a session, the last one holds.
  void ask(const Session& session, const std::string& room);
  /// The same, by its game, which may ask as often as it likes.
  void askByGame(Session& session, const std::string& room);
  /// This room has no world any more: its players go to the first room, or out.
  void leadAway(const Room& room, const std::string& sentence);
  /// Once a tick, outside of any session's callback.
  void update();
  /// Send the session the list of rooms, if that can arrive at once.
  void sendList(Session& session) const;

 private:
  struct Wish {
    std::uint64_t session = 0;
    std::string room;
    std::string or_goodbye = {};  ///< if it cannot be; empty: the player stays
  };
  void grant(const Wish& wish);
  void refuse(Session& session, const Wish& wish, const std::string& sentence);

  HostContext& m_context;
  SessionTable& m_sessions;
  Rooms& m_rooms;
  Admission& m_admission;
  std::vector<Wish> m_wishes;  ///< one of a session at most
};

}  // namespace naiad
