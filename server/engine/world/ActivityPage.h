// Records which handler of a world's game is running, for reports after a crash or a hang.
//
// The page is plain data of fixed size, without pointers that a reader follows. If a world has a process of
// its own, the page is in memory shared with the host, which reads it after that process was killed. A reader
// must not trust any byte, because the game can write anything to the page.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace df {

/// Identifies the class of a polymorphic object by the address of its vtable (Itanium C++ ABI, which GCC and
/// Clang follow). Reads one word and calls nothing.
template <class T>
inline std::uintptr_t classOf(const T& object) {
  std::uintptr_t table = 0;
  std::memcpy(&table, static_cast<const void*>(&object), sizeof table);
  return table;
}

/// The running handler. The thread that ticks writes it; any thread or process may read it.
struct alignas(16) Activity {
  static constexpr std::uintptr_t kNothing = 0;
  static constexpr std::uintptr_t kDraw = 1;  ///< value of event_class while draw() runs

  std::atomic<std::uintptr_t> object_class{kNothing};
  std::atomic<std::uintptr_t> event_class{kNothing};
};

/// Marks a handler as running until destroyed, then restores the previous one. Costs 2 loads and 4 stores.
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

/// The running handler, the names of classes, and the log's last lines. Zeroed memory is a valid empty page.
struct ActivityPage {
  static constexpr std::size_t kNames = 256;
  static constexpr std::size_t kLines = 8;

  struct Name {
    std::atomic<std::uintptr_t> id;
    char text[56];  ///< std::type_info::name(), truncated to this size; ends with a zero if it is shorter
  };
  struct Line {
    char text[160];
  };

  Activity now;
  std::atomic<std::uint32_t> lines_written;  ///< lines so far; index of the next, modulo kLines
  Name names[kNames];                        ///< hash table by id
  Line lines[kLines];

  // Call these on the thread that ticks the world.

  /// Stores the name of a class; does nothing if kNames classes are stored.
  void addName(std::uintptr_t id, const char* p_mangled);
  /// Stores a line, truncated to the size of Line::text.
  void addLine(std::string_view line);
};

static_assert(std::atomic<std::uintptr_t>::is_always_lock_free);

}  // namespace df
