// A round that goes on in the program that is installed by now: dfctl restart --keep.
//
// dfreplay, which is installed beside the new dfserver, executes the round again with it, in processes beside
// the game, and holds every answer against the file. When all are the same and both ends of the wire keep
// their protocol, this process leaves the journal open, as if it had been killed, and runs the new program in
// its own place, with the sockets that players come to. That one goes on with the round as after a crash
// (Journals.h), and so players are back as the same players.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "host/net/InheritedSockets.h"
#include "host/program/Journals.h"

namespace naiad {

class RoundHandover {
 public:
  /// `program`: the path of dfserver that is run again. `module`: of the game. Outlived by what `done` of
  /// prove() uses.
  RoundHandover(std::string program, std::string module, std::shared_ptr<Journals> journals);
  /// A proof that is under way ends.
  ~RoundHandover();
  RoundHandover(const RoundHandover&) = delete;
  RoundHandover& operator=(const RoundHandover&) = delete;

  // On the host's thread.

  /// Why no round can be kept now, as the rest of a sentence; empty: one can.
  std::string refusal() const;
  /// Execute the round again. `done` gets why it cannot go on, as the rest of a sentence; empty: it can. It
  /// is called once, on a thread of this, unless this ends before. Only without a refusal().
  void prove(std::function<void(const std::string& problem)> done);
  /// From now on nothing is written down, and another program goes on with the round. `port`: of the server.
  void leaveOpen(std::uint16_t port);
  /// After leaveOpen(): the sockets to hand over; nothing if the program is to open its own.
  const std::optional<InheritedSockets>& sockets() const { return m_sockets; }
  /// After leaveOpen(): let the program that this process runs next know which round it is.
  void announce() const;

 private:
  std::string execute(const std::string& file);
  int runReplay(const std::string& file, std::string& printed);

  const std::string m_program;
  const std::string m_module;
  const std::shared_ptr<Journals> m_journals;
  std::optional<InheritedSockets> m_sockets;
  std::string m_proven_hash;  ///< of the module
  std::thread m_thread;
  std::atomic<bool> m_proving{false};
  std::mutex m_mutex;  ///< of m_replay and m_ends
  pid_t m_replay = 0;  ///< dfreplay's process; 0: it does not run
  bool m_ends = false;
};

/// What came of dfreplay --verify by its exit code and what it printed: why the round cannot go on; empty: it
/// can.
std::string readVerdict(int code, const std::string& printed);

}  // namespace naiad
