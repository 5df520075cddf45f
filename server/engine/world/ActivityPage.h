// What a world's game is doing: written before each handler, read by others after a crash or a hang.
//
// Plain data of a fixed size, without pointers that a reader follows: a world in a process of its own has it
// in memory that it shares with its host, which reads it when that process was killed. A reader takes every
// byte for a stranger's: the game can write anything here.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace df {

/// Which class a polymorphic object is of: the address of its vtable, by the Itanium C++ ABI, which GCC and
/// Clang follow. It reads one word, and calls nothing.
template <class T>
inline std::uintptr_t classOf(const T& object) {
  std::uintptr_t table = 0;
  std::memcpy(&table, static_cast<const void*>(&object), sizeof table);
  return table;
}

/// The handler that is running. Written by the thread that ticks; any thread or process may read it.
struct alignas(16) Activity {
  static constexpr std::uintptr_t kNothing = 0;
  static constexpr std::uintptr_t kDraw = 1;  ///< in place of an event: draw()

  std::atomic<std::uintptr_t> object_class{kNothing};
  std::atomic<std::uintptr_t> event_class{kNothing};
};

/// While it lives, this handler is running; then the one that was before. Two loads and four stores.
class ActivityScope {
 public:
  ActivityScope(Activity& activity, std::uintptr_t object_class, std::uintptr_t event_class)
      : m_activity(activity),
        m_object_class(activity.object_class.load(std::memory_order_relaxed)),
        m_event_class(activity.event_class.load(std::memory_order_relaxed)) {
    set(object_class, event_class);
  }
  ~ActivityScope() { set(m_object_class, m_event_class); }
  ActivityScope(const ActivityScope&) = delete;
  ActivityScope& operator=(const ActivityScope&) = delete;

 private:
  void set(std::uintptr_t object_class, std::uintptr_t event_class) {
    m_activity.object_class.store(object_class, std::memory_order_relaxed);
    m_activity.event_class.store(event_class, std::memory_order_relaxed);
  }

  Activity& m_activity;
  std::uintptr_t m_object_class;
  std::uintptr_t m_event_class;
};

/// The same with what a reader needs: names of classes, and the last lines of the log. Fresh memory is all
/// zeros, which is an empty page.
struct ActivityPage {
  static constexpr std::size_t kNames = 256;
  static constexpr std::size_t kLines = 8;

  struct Name {
    std::atomic<std::uintptr_t> id;
    char text[56];  ///< as of std::type_info::name(); ends with a zero if it is shorter
  };
  struct Line {
    char text[160];
  };

  Activity now;
  std::atomic<std::uint32_t> lines_written;  ///< so far; the next is at this modulo kLines
  Name names[kNames];                        ///< hashed by id
  Line lines[kLines];

  // By the world's thread.

  /// Classes beyond kNames have no name here.
  void addName(std::uintptr_t id, const char* p_mangled);
  /// What does not fit is cut off.
  void addLine(std::string_view line);
};

static_assert(std::atomic<std::uintptr_t>::is_always_lock_free);

}  // namespace df
