// Rounds that go on in the program that is installed by now: dfctl restart --keep.
//
// dfreplay, which is installed beside the new dfserver, executes each round again with it, in processes
// beside the game, and holds every answer against the file. When all are the same and both ends of the wire
// keep their protocol, this process leaves the journals open, as if it had been killed, and runs the new
// program in its own place, with the sockets that players come to. That one goes on with the rounds as after
// a crash (Journals.h), and so players are back as the same players.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "host/net/InheritedSockets.h"
#include "host/process/ProgramRun.h"
#include "host/process/Restart.h"
#include "host/rounds/Journals.h"

namespace naiad {

class RoundHandover {
 public:
  /// For dfreplay: so much, and of the time that the round has been played this part, for it is executed at
  /// least twenty times as fast; never more than the last.
  static constexpr std::chrono::seconds kLeastTime{60};
  static constexpr int kPartOfRound = 4;
  static constexpr std::chrono::hours kMaxTime{1};

  /// Where a round may be played.
  struct Room {
    std::string name;  ///< empty: the server has no rooms
    std::shared_ptr<Journals> journals;
  };

  /// What came of a proof.
  struct Result {
    std::string problem;  ///< why the rounds cannot go on, as the rest of a sentence; empty: they can
    bool starts = true;   ///< the program does, so that it can be begun once the rounds are over
  };

  /// `command`: that runs dfserver again; outlives this. What `done` of prove() uses outlives it, too.
  RoundHandover(const StartCommand& command, std::vector<Room> rooms);
  /// A proof that is under way ends.
  ~RoundHandover();

  // On the host's thread.

  /// Why no round can be kept now, as the rest of a sentence; empty: one can.
  std::string refusal() const;
  /// Execute the rounds again. `done` is called once, on a thread of this, unless this ends before. Only
  /// without a refusal().
  void prove(std::function<void(const Result& result)> done);
  /// After a proof without a problem: what has changed since, so that it says nothing any more; empty:
  /// nothing has.
  std::string changeSinceProof() const;
  /// From now on nothing is written down, and another program goes on with the rounds. `port`: of the server.
  void leaveOpen(std::uint16_t port);
  /// After leaveOpen(): the sockets to hand over; nothing if the program is to open its own.
  const std::optional<InheritedSockets>& sockets() const { return m_sockets; }
  /// After leaveOpen(): let the program that this process runs next know which rounds they are.
  void announce() const;

 private:
  struct Proof {
    const Room* p_room = nullptr;
    Journals::CurrentRound round;
    std::string module_hash = {};  ///< of the game that played it the same
  };

  Result execute();
  std::string problemOfProgram();
  std::string problemOf(Proof& proof);

  const StartCommand& m_command;
  const std::vector<Room> m_rooms;
  std::vector<Proof> m_proofs;  ///< the thread's while it proves
  std::optional<InheritedSockets> m_sockets;
  std::thread m_thread;
  std::atomic<bool> m_proving{false};
  ProgramRun m_run;
};

/// What came of dfreplay --verify: why the round cannot go on; empty: it can.
std::string readVerdict(const ProgramEnd& end);

}  // namespace naiad
