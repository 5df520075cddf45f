#include "host/loop/OperatorLibrary.h"

#include <dlfcn.h>

#include <filesystem>

#include "host/rooms/HostContext.h"

namespace naiad {

namespace {

/// Loads the library permanently and returns its function; null on failure (dlerror). Looks next to the
/// library of this code, because the address sanitizer's dlopen() ignores our RUNPATH.
MakeOperatorParts* load() {
  Dl_info own{};
  std::filesystem::path path = dladdr(reinterpret_cast<const void*>(&load), &own) != 0 ? own.dli_fname : "";
  void* const handle = dlopen(path.replace_filename("libdragonfly-ops.so.0").c_str(), RTLD_NOW | RTLD_LOCAL);
  return handle != nullptr ? reinterpret_cast<MakeOperatorParts*>(dlsym(handle, kMakeOperatorParts))
                           : nullptr;
}

}  // namespace

std::string operatorPartsProblem() {
  return load() != nullptr ? std::string() : dlerror();
}

std::vector<std::unique_ptr<HostPart>> makeOperatorParts(const HostAccess& access) {
  std::vector<std::unique_ptr<HostPart>> parts;
  if (MakeOperatorParts* const make = load()) {
    make(access, parts);
  } else {
    access.context.log(LogEvent::warning(
        "scores, bans, dfctl, metrics, local network and bus are not available: " + std::string(dlerror())));
  }
  return parts;
}

}  // namespace naiad
