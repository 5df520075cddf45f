// Which build of a library this process has loaded: two with the same id have the same bytes.
#pragma once

#include <string>
#include <string_view>

namespace naiad {

/// The linker's build id of the first loaded file whose name begins with `name`, like "libdragonfly.so", as
/// hexadecimal digits; of the program itself if `name` is empty. Empty: there is no such file, or it has no
/// id. Thread-safe.
std::string buildIdOf(std::string_view name);

}  // namespace naiad
