// What a shell completes after "dfctl ", made from the table of commands.
#pragma once

#include <optional>
#include <string>

namespace naiad {

/// A script for "bash", "zsh" or "fish"; nothing for other shells.
std::optional<std::string> ctlCompletion(const std::string& shell);
/// dfctl(1), for man.
std::string ctlManPage();

}  // namespace naiad
