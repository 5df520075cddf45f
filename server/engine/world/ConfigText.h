// Text of the form "key:value,key:value," in which blanks and newlines mean nothing.
#pragma once

#include <optional>
#include <string>

#include "shared/values/Vector.h"

namespace df {

/// The value of the first such key; empty if there is none.
std::string valueOf(const std::string& text, const std::string& key);

/// The value as a number; nullopt if there is no such key or the value is not a number.
std::optional<double> numberOf(const std::string& text, const std::string& key);
/// The numbers under key-x and key-y.
std::optional<Vector> vectorOf(const std::string& text, const std::string& key);

/// "key:value,"; of a vector "key-x:…,key-y:…,".
std::string keyValue(const std::string& key, const std::string& value);
std::string keyValue(const std::string& key, double value);
std::string keyValue(const std::string& key, Vector v);

}  // namespace df
