// Text of the form "key:value,key:value," in which blanks and newlines mean nothing.
#pragma once

#include <string>

namespace df {

/// The value of the first such key; empty if there is none.
std::string valueOf(const std::string& text, const std::string& key);

}  // namespace df
