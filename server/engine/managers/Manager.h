// Base of the engine's managers, and of managers that a game adds (book, Listing 4.2).
//
// The engine's own managers hold no state: each call goes to the calling thread's current World. A
// reference to one may be kept for ever.
#pragma once

#include <string>

#include "Event.h"
#include "Object.h"
#include "ObjectList.h"
#include "StandardHeaders.h"

// Games ask whether registerInterest() is there.
#if !defined(DF_REGISTER_INTEREST)
#define DF_REGISTER_INTEREST
#endif

namespace df {

// The macros of the managers say df:: themselves; games write df::GM.run() nevertheless.
namespace df = ::df;

/// Of the published engine, for games that name it: here there is no limit.
inline constexpr int MAX_EVENTS = 100;

class Manager {
 public:
  Manager() = default;
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;
  virtual ~Manager() = default;

  /// A name, for log lines.
  const std::string& getType() const { return m_type; }

  /// Get ready. Return 0 if ok, else -1.
  virtual int startUp();
  /// Give up what startUp() got.
  virtual void shutDown();
  /// True between startUp() and shutDown().
  virtual bool isStarted() const;

  /// Send `p_event` to the Objects that registered interest in its type, in the order they registered.
  /// Return to how many it was sent; 0 for null. See EventDispatch::onEvent for what happens to Objects that
  /// come, go or fall asleep meanwhile.
  int onEvent(const Event* p_event) const;

  /// Object::registerInterest(), seen from the other side.
  int registerInterest(Object* p_o, const std::string& event_type);
  int unregisterInterest(Object* p_o, const std::string& event_type);
  /// Whether events of this type come from this manager: for games' own managers. The engine does not call
  /// it.
  virtual bool isValid(std::string /*event_type*/) const { return true; }

 protected:
  /// For the engine's own: `started` is the manager's bit in Started.h, which the current world keeps.
  Manager(std::string type, unsigned started) : m_type(std::move(type)), m_started(started) {}
  /// Its name, for getType().
  void setType(std::string type) { m_type = std::move(type); }

 private:
  std::string m_type = "Manager";
  unsigned m_started = 0;  // 0: not one of the engine's, m_is_started counts
  bool m_is_started = false;
};

}  // namespace df
