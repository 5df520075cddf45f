// The calls of the public API that built and changed a world, written as a program.
#pragma once

#include <string>
#include <vector>

#include "physics/body/PhysicsManager.h"
#include "shared/values/Box.h"
#include "shared/values/Solidness.h"
#include "shared/values/Vector.h"

namespace hunt {

/// A piece of code that is written as it is, such as the name of a variable.
struct Code {
  std::string text;
};

class Script {
 public:
  /// If `writes` is false, nothing is recorded.
  explicit Script(bool writes) : m_writes(writes) {}

  /// Appends `before` function(arguments…), as one statement.
  template <class... Arguments>
  void call(const std::string& before, const char* function, const Arguments&... arguments) {
    if (!m_writes) return;
    std::string list;
    ((list += (list.empty() ? "" : ", ") + codeOf(arguments)), ...);
    add(before + function + "(" + list + ");");
  }
  void add(const std::string& statement) {
    if (!m_writes) return;
    if (!m_in_handler) writeUpdates();
    (m_in_handler ? m_handlers : m_steps) += "  " + statement + "\n";
  }
  void update();
  /// Writes the statements up to endHandler() into the handler of the receiver's event with this number.
  void beginHandler(int receiver, int event);
  void endHandler();
  /// Returns the whole program, with a comment in front.
  std::string program(const std::string& comment, const std::string& fields, std::size_t bodies,
                      std::size_t obstacles, std::size_t joints) const;

  static std::string codeOf(double value);
  static std::string codeOf(bool value) { return value ? "true" : "false"; }
  static std::string codeOf(df::Vector v) { return "Vector(" + codeOf(v.x()) + ", " + codeOf(v.y()) + ")"; }
  template <class Named>
  static std::string codeOf(const Named* p_named) {
    return p_named == nullptr ? "nullptr" : p_named->code();
  }
  static std::string codeOf(const Code& code) { return code.text; }
  static std::string codeOf(df::Accuracy level) {
    return level == df::ACCURACY_FAST ? "df::ACCURACY_FAST" : "df::ACCURACY_DEFAULT";
  }
  static std::string codeOf(df::Solidness solidness);
  static std::string codeOf(const df::Box& box);
  static std::string codeOf(const std::vector<df::Vector>& corners);

 private:
  void writeUpdates();

  const bool m_writes;
  std::string m_steps, m_handlers;
  int m_updates = 0;  // not yet written
  bool m_in_handler = false;
};

}  // namespace hunt
