// The programs to attack: those of this build, unless the environment names others.
#pragma once

#include <cstdlib>
#include <string>

namespace bench::attack {

/// Returns a program's path; NAIAD_ATTACK_DFSERVER and NAIAD_ATTACK_DFCLIENT select another version.
inline std::string programAt(const char* variable, const char* name) {
  const char* other = std::getenv(variable);
  return other != nullptr ? other : std::string(NAIAD_BINARY_DIR) + "/" + name;
}
inline std::string serverProgram() {
  return programAt("NAIAD_ATTACK_DFSERVER", "dfserver");
}
inline std::string clientProgram() {
  return programAt("NAIAD_ATTACK_DFCLIENT", "dfclient");
}

}  // namespace bench::attack
