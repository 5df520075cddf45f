// Sends events to the eventHandler()s of a world's Objects. The code that sends one event is inline, because
// a crowded world spends most of its time there.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "engine/world/ActivityPage.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/WorldStore.h"

namespace df {

class Interests;
class ObjectRegistry;
class WorldLog;
struct WorldState;

class EventDispatch {
 public:
  /// Calls `shut_down` after each handler while a shutdown is pending. The others must outlive this object.
  EventDispatch(ObjectRegistry& objects, Interests& interests, const WorldState& state,
                std::function<void()> shut_down);

  /// Sends the event to all Objects that registered interest in its type, in order of registration. An Object
  /// that registers during the call waits for the next event; one that is deleted, unregistered or made
  /// inactive during the call is skipped. While the world is paused, only Pause objects get the event, unless
  /// a player joins or leaves. Returns the number of Objects it was sent to.
  int onEvent(const Event* p_event);
  /// Like onEvent(), but to all Objects even while the world is paused.
  int sendToAll(const Event& event) { return send(event, false); }
  /// Sends the event to one Object, if that is in the world and active. If its handler throws, the Object is
  /// made inactive, marked for deletion and logged. Returns true if the event was sent.
  bool deliver(ObjectKey key, const Event& event);
  /// Runs the eventHandler() of an Object in the world; see deliver().
  [[gnu::always_inline]] void runHandler(ObjectKey key, Object& object, const Event& event) {
    ++m_handlers;
    try {
      const ActivityScope running(*m_p_activity, classOf(object), classOf(event));
      object.eventHandler(&event);
    } catch (const std::exception& e) {
      quarantine(key, e.what());
    } catch (...) {
      quarantine(key, "an exception of unknown type");
    }
    --m_handlers;
    if (m_attends) attend(key);
  }
  /// Sends a collision to the mover, then to the other Object, but not to one that is inactive or has no
  /// handler. Stops if the first handler removes either. Both must be in the world. Returns true if the mover
  /// is still in the world.
  [[gnu::always_inline]] bool sendToBoth(ObjectKey mover, ObjectKey other, const EventCollision& event) {
    const WorldStore& store = m_store;
    if (store.handlesEvents(mover.slot)) {
      runHandler(mover, *event.getObject1(), event);
      if (!store.isCurrentUnchecked(mover)) return false;
      if (!store.isCurrentUnchecked(other)) return true;
    }
    if (store.handlesEvents(other.slot)) {
      runHandler(other, *event.getObject2(), event);
      if (!store.isCurrentUnchecked(mover)) return false;
    }
    return true;
  }
  /// True while an eventHandler() is running.
  bool isRunning() const { return m_handlers > 0; }
  /// Makes an Object whose handler threw inactive, marks it for deletion, and logs why.
  void quarantine(ObjectKey key, const std::string& why);

  /// Makes a shutdown pending, until popShutDown().
  void deferShutDown() { m_shutdown_pending = m_attends = true; }
  /// Returns whether a shutdown was pending, and cancels it.
  bool popShutDown() { return std::exchange(m_shutdown_pending, false); }

  /// Records what the classes of new Objects override, which their constructors cannot know.
  void classifyNewObjects();
  void classifyObject(std::uint32_t slot);

  /// Makes the dispatch record events and handlers on this page (ActivityPage.h). Not owned; null for none.
  void setPage(ActivityPage* p_page);
  /// Returns the record of the running handler, with or without a page.
  Activity& activity() { return *m_p_activity; }
  /// Adds the name of the event's class to the page. Call before the event is sent.
  void nameClassOf(const Event& event) {
    if (m_p_page != nullptr && classOf(event) != m_named_event) addEventName(event);
  }

 private:
  /// The first Object of a class that overrides eventHandler() and registered no interest.
  struct Unheard {
    ObjectKey key;
    int due;  ///< step count at which it is reported
  };

  int send(const Event& event, bool is_paused);
  void attend(ObjectKey key);
  void reportUnheard();
  void addClassName(std::uint32_t slot);
  void addEventName(const Event& event);

  WorldStore& m_store;
  ObjectRegistry& m_objects;
  Interests& m_interests;
  WorldLog& m_log;
  const WorldState& m_state;
  int m_handlers = 0;  // number of running handlers: they may be nested
  bool m_shutdown_pending = false;
  bool m_attends = false;  // attend() is called after handlers: a shutdown is pending, or a class is unheard
  std::map<std::uintptr_t, Unheard> m_unheard;  // by class
  std::function<void()> m_shut_down;
  Activity m_own_activity;
  Activity* m_p_activity = &m_own_activity;  // m_own_activity, or that of m_p_page
  ActivityPage* m_p_page = nullptr;          // null: no page
  std::uintptr_t m_named_event = 0;          // class whose name was added last
};

}  // namespace df
