// The calls of the public API that built and changed a world, written as a program.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
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
    if (!m_in_handler) writeUpdates();
    (m_in_handler ? m_handlers : m_steps) += "  " + statement + "\n";
  }
  void update() { ++m_updates; }
  /// Writes the statements up to endHandler() into the handler of the receiver's event with this number.
  void beginHandler(int receiver, int event) {
    m_in_handler = true;
    m_handlers += "  handlers[{" + std::to_string(receiver) + ", " + std::to_string(event) + "}] = [&] {\n";
  }
  void endHandler() {
    m_handlers += "  };\n";
    m_in_handler = false;
  }
  std::string handlersAndSteps() {
    writeUpdates();
    return m_handlers + m_steps;
  }

  static std::string codeOf(double value) {
    if (std::isinf(value)) return value > 0 ? "HUGE_VAL" : "-HUGE_VAL";
    std::array<char, 40> digits;
    return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
  }
  static std::string codeOf(bool value) { return value ? "true" : "false"; }
  static std::string codeOf(df::Vector v) { return "Vector(" + codeOf(v.x()) + ", " + codeOf(v.y()) + ")"; }
  template <class Named>
  static std::string codeOf(const Named* p_named) {
    return p_named == nullptr ? "nullptr" : p_named->code();
  }
  static std::string codeOf(const Code& code) { return code.text; }
  static std::string codeOf(df::Accuracy level) {
    return level == df::ACCURACY_FAST ? "ACCURACY_FAST" : "ACCURACY_DEFAULT";
  }
  static std::string codeOf(df::Solidness solidness) {
    return solidness == df::HARD ? "HARD" : solidness == df::SOFT ? "SOFT" : "SPECTRAL";
  }
  static std::string codeOf(const df::Box& box) {
    return "Box(" + codeOf(box.getCorner()) + ", " + codeOf(box.width()) + ", " + codeOf(box.height()) + ")";
  }
  static std::string codeOf(const std::vector<df::Vector>& corners) {
    std::string list;
    for (const df::Vector corner : corners) list += (list.empty() ? "" : ", ") + codeOf(corner);
    return "{" + list + "}";
  }

 private:
  void writeUpdates() {
    if (m_updates > 0) m_steps += "  update(" + std::to_string(m_updates) + ");\n";
    m_updates = 0;
  }

  const bool m_writes;
  std::string m_steps, m_handlers;
  int m_updates = 0;  // not yet written
  bool m_in_handler = false;
};

}  // namespace hunt
