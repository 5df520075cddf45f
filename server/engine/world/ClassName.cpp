#include "engine/world/ClassName.h"

#include <cxxabi.h>

#include <cstdlib>
#include <memory>
#include <string_view>

#include "engine/world/ObjectProfile.h"

namespace df {

std::string classNameOf(const std::type_info& type) {
  constexpr std::string_view kAnonymous = "(anonymous namespace)::";
  int status = 0;
  const std::unique_ptr<char, decltype(&std::free)> p_name(
      abi::__cxa_demangle(type.name(), nullptr, nullptr, &status), &std::free);
  std::string name = p_name != nullptr ? p_name.get() : type.name();
  for (std::size_t at = 0; (at = name.find(kAnonymous)) != std::string::npos;) {
    name.erase(at, kAnonymous.size());
  }
  return name;
}

std::string nameOf(const std::string& type, const std::type_info& dynamic) {
  return type == ObjectProfile().type || type == kUndefinedType ? classNameOf(dynamic) : type;
}

}  // namespace df
