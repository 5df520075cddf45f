// Moves players between rooms: on request of their client or game, or because their room was closed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/admission/Admission.h"
#include "host/rooms/RoomManager.h"
#include "host/rooms/SessionTable.h"

namespace naiad {

/// Not thread-safe.
class RoomTransfers {
 public:
  /// All arguments must outlive this.
  RoomTransfers(HostContext& context, SessionTable& sessions, RoomManager& rooms, Admission& admission)
      : m_context(context), m_sessions(sessions), m_rooms(rooms), m_admission(admission) {}

  /// Requests a move for the next update(). The last request of a session wins.
  void ask(const Session& session, const std::string& room);
  /// Like ask(), on request of the game. Rate-limited, because games may ask as often as they like.
  void askByGame(Session& session, const std::string& room);
  /// Call when this room was closed. Tells its players `sentence` (the reason), and moves them to the first
  /// room; ends sessions that cannot move. If it is the first room, ends all of its sessions.
  void evacuate(const Room& room, const std::string& sentence);
  /// Performs the requested moves. Call once a tick, outside of session callbacks.
  void update();
  /// Sends the room list to the session, or drops it if it cannot be sent at once.
  void sendList(Session& session) const;

 private:
  struct Request {
    std::uint64_t session = 0;
    std::string room;
    std::string goodbye_message =
        {};  ///< last message of the session if the move fails; empty: the player stays
  };
  void grant(const Request& request);
  void refuse(Session& session, const Request& request, const std::string& sentence);

  HostContext& m_context;
  SessionTable& m_sessions;
  RoomManager& m_rooms;
  Admission& m_admission;
  std::vector<Request> m_requests;  ///< at most one per session
};

}  // namespace naiad
