// A world that runs a Scene, in this project's engine or in a peer, that is, another library.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

namespace bench {

/// Counters of a world's handlers. In every engine, handling an event only changes these. Engines that send
/// equal events in equal order have equal checksums at the end.
struct Tally {
  std::uint64_t tick = 0;      ///< number of the present tick, from 1
  std::uint64_t events = 0;    ///< collision events received
  std::uint64_t blocked = 0;   ///< moves blocked by a HARD object
  std::uint64_t checksum = 0;  ///< checksum of the receivers' ids, in the order of events

  void event(std::uint64_t receiver) {
    ++events;
    checksum = checksum * 0x9e3779b97f4a7c15u + receiver;
  }
};

class Engine {
 public:
  virtual ~Engine() = default;

  /// Runs a tick: each body with a velocity takes a turn, in id order.
  virtual void tick() = 0;
  virtual const Tally& tally() const = 0;
  /// Returns a hash of all positions and velocities in id order, equal in engines that agree.
  virtual std::uint64_t stateHash() const = 0;
  /// Returns 1 if tick() runs a whole tick. Otherwise returns the part of a tick that it runs, because a
  /// whole one takes too long; then results are not compared with other engines'.
  virtual double partOfTick() const { return 1; }
};

using EnginePtr = std::unique_ptr<Engine>;

/// Computes stateHash(). Coordinates must be multiples of 2^-10 cell.
class StateHash {
 public:
  void add(double coordinate) {
    m_hash ^= static_cast<std::uint64_t>(std::llround(coordinate * 1024));
    m_hash *= 0x100000001b3u;  // FNV-1a on whole words
  }
  std::uint64_t value() const { return m_hash; }

 private:
  std::uint64_t m_hash = 0xcbf29ce484222325u;
};

}  // namespace bench
