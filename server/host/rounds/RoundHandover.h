// Hands rounds over to a newly installed program: dfctl restart --keep.
//
// The new dfreplay, installed with the new dfserver, replays each round in processes of its own while the
// game continues, and compares every answer with the file. If all are equal and the network protocol is
// unchanged, this process leaves the journals open, as if it had been killed, and executes the new program in
// its own place, with its listening sockets. The new program resumes the rounds as after a crash
// (RoundJournals.h), and so players keep their sessions.
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
#include "host/process/ChildProcess.h"
#include "host/process/ReexecCommand.h"
#include "host/rounds/RoundJournals.h"

namespace naiad {

class RoundHandover {
 public:
  /// Time limit of dfreplay: kMinTime + played time / kPartOfRound, at most kMaxTime. A replay is at least
  /// twenty times as fast as the round.
  static constexpr std::chrono::seconds kMinTime{60};
  static constexpr int kPartOfRound = 4;
  static constexpr std::chrono::hours kMaxTime{1};

  /// A room, in which a round may be played.
  struct Room {
    std::string name;  ///< empty: the server has no rooms
    std::shared_ptr<RoundJournals> journals;
  };

  /// Result of a proof, that is, of replaying the rounds with the new program.
  struct Result {
    std::string problem;  ///< why the rounds cannot be handed over, as the rest of a sentence; or empty
    bool starts = true;   ///< true if the new program starts, so that it can run when the rounds are over
  };

  /// `command` runs dfserver again, and must outlive this object. So must all that `done` of verify() uses.
  RoundHandover(const ReexecCommand& command, std::vector<Room> rooms);
  /// Ends a running proof.
  ~RoundHandover();

  // Call these on the host's thread.

  /// Returns why the rounds cannot be handed over now, as the rest of a sentence; empty if they can.
  std::string blocker() const;
  /// Replays the rounds. `done` is called once, on a thread of this object, at the latest in the destructor.
  /// Call only if blocker() is empty.
  void verify(std::function<void(const Result& result)> done);
  /// Returns the change since a successful proof that makes the proof invalid; empty if nothing has changed.
  std::string changeSinceVerification() const;
  /// Stops recording, so that another program can resume the rounds. `port`: the server's port.
  void suspend(std::uint16_t port);
  /// Returns the sockets to hand over, after suspend(); nullopt if the program must open its own.
  const std::optional<InheritedSockets>& sockets() const { return m_sockets; }
  /// Tells the program that this process runs next which rounds were left open. Call after suspend().
  void exportRounds() const;

 private:
  struct Verification {
    const Room* p_room = nullptr;
    RoundJournals::CurrentRound round;
    std::string module_hash = {};  ///< hash of the game that replayed it with equal answers
  };

  Result execute();
  std::string problemOfProgram();
  std::string problemOf(Verification& proof);

  const ReexecCommand& m_command;
  const std::vector<Room> m_rooms;
  std::vector<Verification> m_verifications;  ///< used by the thread during a proof
  std::optional<InheritedSockets> m_sockets;
  std::thread m_thread;
  std::atomic<bool> m_verifying{false};
  ChildProcess m_run;
};

/// Returns why the round cannot be handed over, from the result of dfreplay --verify; empty if it can.
std::string parseVerifyResult(const ChildExit& end);

}  // namespace naiad
