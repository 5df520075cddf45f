#include "Script.h"

#include <array>
#include <charconv>
#include <cmath>

namespace hunt {
namespace {

constexpr const char* kBegin = R"(#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <vector>

#include "Body.h"
#include "EventCollision.h"
#include "EventContactEnd.h"
#include "Field.h"
#include "PhysicsManager.h"
#include "WorldManager.h"

using df::Box;
using df::Vector;

int tick = 0;
std::map<std::pair<int, int>, std::function<void()>> handlers;  // by body and number of its event

struct TracedBody;
std::map<int, TracedBody*> traced;

struct TracedBody : df::Body {
  explicit TracedBody(int its_index) : index(its_index) { traced[index] = this; }
  ~TracedBody() override { traced.erase(index); }
  int eventHandler(const df::Event* p_event) override {
    const bool begins = p_event->getType() == df::COLLISION_EVENT;
    if (!begins && p_event->getType() != df::CONTACT_END_EVENT) return 0;
    std::printf("tick %d: body %d: a contact %s\n", tick, index, begins ? "begins" : "ends");
    if (const auto found = handlers.find({index, events++}); found != handlers.end()) found->second();
    return 1;
  }
  int index, events = 0;
};

void update(int ticks) {
  while (ticks-- > 0) {
    WM.update();
    ++tick;
    for (const auto& [index, p_body] : traced) {
      const Vector place = p_body->getPosition(), velocity = p_body->getVelocity();
      std::printf("%d %d: %.9g %.9g  %.9g %.9g  %.9g %.9g\n", tick, index, place.x(), place.y(),
                  velocity.x(), velocity.y(), p_body->getAngle(), p_body->getSpin());
    }
  }
}

)";

}  // namespace

void Script::update() {
  ++m_updates;
}

void Script::writeUpdates() {
  if (m_updates > 0) m_steps += "  update(" + std::to_string(m_updates) + ");\n";
  m_updates = 0;
}

std::string Script::codeOf(double value) {
  if (std::isinf(value)) return value > 0 ? "HUGE_VAL" : "-HUGE_VAL";
  std::array<char, 40> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string Script::codeOf(df::Solidness solidness) {
  return solidness == df::HARD ? "df::HARD" : solidness == df::SOFT ? "df::SOFT" : "df::SPECTRAL";
}

std::string Script::codeOf(const df::Box& box) {
  return "Box(" + codeOf(box.getCorner()) + ", " + codeOf(box.width()) + ", " + codeOf(box.height()) + ")";
}

std::string Script::codeOf(const std::vector<df::Vector>& corners) {
  std::string list;
  for (const df::Vector corner : corners) list += (list.empty() ? "" : ", ") + codeOf(corner);
  return "{" + list + "}";
}

void Script::beginHandler(int receiver, int event) {
  if (!m_writes) return;
  m_in_handler = true;
  m_handlers += "  handlers[{" + std::to_string(receiver) + ", " + std::to_string(event) + "}] = [&] {\n";
}

void Script::endHandler() {
  if (!m_writes) return;
  m_handlers += "  };\n";
  m_in_handler = false;
}

std::string Script::program(const std::string& comment, const std::string& fields, std::size_t bodies,
                            std::size_t obstacles, std::size_t joints) const {
  const auto list = [](const char* type, const char* name, std::size_t size) {
    return std::string("  std::vector<") + type + "> " + name + "(" + std::to_string(size) + ");\n";
  };
  Script whole = *this;
  whole.writeUpdates();
  return "// " + comment + "\n" + kBegin + fields + "int main() {\n" + list("TracedBody*", "bodies", bodies) +
         list("df::Object*", "obstacles", obstacles) + list("df::Joint", "joints", joints) + m_handlers +
         whole.m_steps + "}\n";
}

}  // namespace hunt
