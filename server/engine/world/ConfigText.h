// Reads and writes text of the form "key:value,key:value,". Blanks and newlines in the text have no meaning.
#pragma once

#include <optional>
#include <string>

#include "shared/values/Vector.h"

namespace df {

/// Returns the value of the first `key`; empty if the key is missing.
std::string valueOf(const std::string& text, const std::string& key);

/// Returns the value as a number; nullopt if there is no such key or the value is not a number.
std::optional<double> numberOf(const std::string& text, const std::string& key);
/// Returns the vector with the values of "key-x" and "key-y"; nullopt if one is missing or not a number.
std::optional<Vector> vectorOf(const std::string& text, const std::string& key);

/// Returns "key:value,"; for a vector "key-x:…,key-y:…,".
std::string keyValue(const std::string& key, const std::string& value);
std::string keyValue(const std::string& key, double value);
std::string keyValue(const std::string& key, Vector v);

}  // namespace df
