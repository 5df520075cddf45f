// Server and client of one session over datagrams that get lost, doubled, reordered and damaged as a script
// says. Publisher, SnapshotSender, SealedLink and Replica are the product's; the world is a ScriptedWorld.
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "ScriptedWorld.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/replica/Replica.h"

namespace naiad::fuzz {

class ScriptedLink {
 public:
  explicit ScriptedLink(Resend resend);

  /// What the script says, for at most `ticks` ticks.
  void run(Script& script, int ticks);
  /// Nothing new happens and nothing is lost, until nothing is pending, for so many ticks at most.
  void heal(int ticks);
  /// The replica holds what the server thinks was sent to it, and draws what the world draws.
  void requireSame() const;

  /// Called with each snapshot that the client got, before it was read.
  std::function<void(const std::string&)> on_snapshot;
  /// … and with each update that the server got.
  std::function<void(const std::string&)> on_update;

 private:
  enum class Fate { kArrives, kLost, kUnanswered, kHeld, kDoubled, kDamaged };
  struct Sent {
    std::string sealed;
    std::string plain;
  };

  void tick(Fate fate, Script* p_script);
  void settlePath();
  void deliver(const Sent& sent, bool answered);
  void damage(const Sent& sent, Script& script);
  void deliverHeld(bool backwards);
  void hear(const std::string& bytes);
  bool takeEpoch(const std::string& bytes);
  void answer(bool arrives);
  void reset();

  ScriptedWorld m_world;
  Publisher m_publisher;
  SnapshotSender m_sender;
  std::uint64_t m_challenge = 0;
  SealedLink m_server_link;
  SealedLink m_client_link;
  SealedLink::Time m_now{std::chrono::hours(1)};
  std::deque<Sent> m_held;
  std::deque<std::string> m_updates;  ///< sealed, on their way up
  Replica m_replica;
  AckWindow m_acks;
  std::uint8_t m_epoch = 0;  ///< of the replica
  std::uint8_t m_server_epoch = 0;
  std::uint32_t m_input = 0;
};

}  // namespace naiad::fuzz
