// Base class of the engine's managers, and of managers that a game adds (book, Listing 4.2).
//
// The engine's own managers have no state: each call goes to the calling thread's current World. A reference
// to such a manager never becomes invalid.
#pragma once

#include <string>

#include "Event.h"
#include "Object.h"
#include "ObjectList.h"
#include "StandardHeaders.h"

// Games test this macro to learn whether managers have registerInterest().
#if !defined(DF_REGISTER_INTEREST)
#define DF_REGISTER_INTEREST
#endif

namespace df {

// Lets games write df::GM.run(), although the macros of the managers contain df:: themselves.
namespace df = ::df;

/// The published engine's limit, for games that use the name. Naiad does not limit the number.
inline constexpr int MAX_EVENTS = 100;

class Manager {
 public:
  Manager() = default;
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;
  virtual ~Manager() = default;

  /// Returns the manager's name, for log lines.
  const std::string& getType() const { return m_type; }

  /// Starts the manager. Returns 0 if ok, else -1.
  virtual int startUp();
  /// Stops the manager. An override releases the resources that its startUp() acquired.
  virtual void shutDown();
  /// True between startUp() and shutDown().
  virtual bool isStarted() const;

  /// Sends `p_event` to the Objects that registered interest in its type, in order of registration. Returns
  /// the number of Objects it was sent to; 0 for null. EventDispatch::onEvent() documents the effect of
  /// Objects that register, are deleted or become inactive during the call.
  int onEvent(const Event* p_event) const;

  /// Calls registerInterest() or unregisterInterest() of the Object. Returns -1 if `p_o` is null.
  int registerInterest(Object* p_o, const std::string& event_type);
  int unregisterInterest(Object* p_o, const std::string& event_type);
  /// True if this manager sends events of this type. For games' own managers; the engine does not call it.
  virtual bool isValid(std::string /*event_type*/) const { return true; }

 protected:
  /// Makes one of the engine's own managers. `started` is its bit in Started.h, in which the current world
  /// records whether it is started.
  Manager(std::string type, unsigned started) : m_type(std::move(type)), m_started(started) {}
  /// Sets the name for getType().
  void setType(std::string type) { m_type = std::move(type); }

 private:
  std::string m_type = "Manager";
  unsigned m_started = 0;  // 0: a game's own manager, which uses m_is_started
  bool m_is_started = false;
};

}  // namespace df
