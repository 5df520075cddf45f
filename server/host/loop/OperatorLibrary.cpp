#include "host/loop/OperatorLibrary.h"

#include <dlfcn.h>

#include "host/rooms/HostContext.h"

namespace naiad {

namespace {

constexpr const char* kLibrary = "libdragonfly-ops.so.0";

/// Null: it cannot be loaded (dlerror). It stays for as long as the process.
MakeOperatorParts* load() {
  void* const handle = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
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
    access.context.log(LogEvent::warning("no scores, bans, dfctl, metrics, local network or bus: " +
                                         std::string(dlerror())));
  }
  return parts;
}

}  // namespace naiad
