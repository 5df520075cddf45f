#include "engine/world/Runner.h"

#include <cstdlib>
#include <optional>
#include <string_view>

#include "engine/world/World.h"

namespace df {

namespace running {

namespace {

// Set while programs and modules are loaded, in any order with what else is initialised then.
constinit Program* g_p_program = nullptr;
constinit std::optional<bool> g_declared;

}  // namespace

void setProgram(Program* p_program) {
  g_p_program = p_program;
}

bool declareCompat(bool compat) {
  g_declared = compat;
  return compat;
}

void beginCompat(World& world) {
  if (g_declared) {
    world.setCompat(*g_declared);
  } else if (world.program() != nullptr) {
    world.setCompat(true);
  }
}

void endCompat(World& world) {
  const char* p_wanted = std::getenv("DF_COMPAT");
  if (p_wanted == nullptr) return;
  const std::string_view wanted(p_wanted);
  if (wanted == "0" || wanted == "false") world.setCompat(false);
  if (wanted == "1" || wanted == "true") world.setCompat(true);
}

}  // namespace running

running::Program* World::program() const {
  return m_p_runner == nullptr && m_is_default ? running::g_p_program : nullptr;
}

}  // namespace df
