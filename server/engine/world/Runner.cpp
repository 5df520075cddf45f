#include "engine/world/Runner.h"

#include <cstdlib>
#include <optional>
#include <string_view>

namespace df {

namespace running {

namespace {

// Set while programs and modules are loaded, before or after other initialisers, so these need constinit.
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

Program* program() {
  return g_p_program;
}

bool beginCompat(bool compat, bool in_program) {
  return g_declared.value_or(compat || in_program);
}

bool endCompat(bool compat) {
  const char* p_wanted = std::getenv("DF_COMPAT");
  if (p_wanted == nullptr) return compat;
  const std::string_view wanted(p_wanted);
  if (wanted == "0" || wanted == "false") return false;
  return compat || wanted == "1" || wanted == "true";
}

}  // namespace running

}  // namespace df
