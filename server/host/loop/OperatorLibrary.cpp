#include "host/loop/OperatorLibrary.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "host/rooms/HostContext.h"

namespace naiad {

namespace {

constexpr const char* kLibrary = "libdragonfly-ops.so.0";

/// Beside the library that this code is in. RUNPATH says the same, but the address sanitizer calls dlopen()
/// for a game that is compiled with it, and then the RUNPATH of the sanitizer's library counts.
std::string besideThis() {
  Dl_info info{};
  const bool known =
      dladdr(reinterpret_cast<const void*>(&besideThis), &info) != 0 && info.dli_fname != nullptr;
  return known ? std::filesystem::path(info.dli_fname).replace_filename(kLibrary).string() : kLibrary;
}

/// Null: it cannot be loaded (dlerror). It stays for as long as the process.
MakeOperatorParts* load() {
  void* handle = dlopen(besideThis().c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) handle = dlopen(kLibrary, RTLD_NOW | RTLD_LOCAL);
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
