// What a shell completes after "dfctl ", made from the table of commands.
#pragma once

#include <optional>
#include <string>

namespace naiad {

/// A script for "bash", "zsh" or "fish"; nothing for other shells.
std::optional<std::string> ctlCompletion(const std::string& shell);
/// Of dfctl(1), for man: options, commands, environment, exit status.
std::string ctlManSections();
/// What `dfctl --option-page KIND` prints for the build: "man", or a script for a shell; nothing for another.
std::optional<std::string> ctlPage(const std::string& kind);

}  // namespace naiad
