// Server and client of a session over datagrams that are lost, duplicated, reordered and damaged by a script.
// Publisher, SnapshotSender, SealedLink and Replica are the product's; the world is a ScriptedWorld.
#pragma once

#include <deque>
#include <string>

#include "ScriptedWorld.h"
#include "host/snapshot/SnapshotSender.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/replica/Replica.h"

namespace naiad::fuzz {

class ScriptedLink {
 public:
  explicit ScriptedLink(Resend resend);

  /// Executes the script, at most `ticks` ticks of it.
  void run(Script& script, int ticks);
  /// Runs at most `ticks` ticks without events and losses, until nothing is pending.
  void heal(int ticks);
  /// Requires that the replica has what the server believes it has, and draws the world's picture.
  void requireSame() const;

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
  Replica m_replica;
  AckWindow m_acks;
  std::uint8_t m_epoch = 0;  ///< epoch of the replica
  std::uint8_t m_server_epoch = 0;
  std::uint32_t m_input = 0;
};

}  // namespace naiad::fuzz
