#include "shared/fleet/ServerId.h"

#include <algorithm>

namespace naiad {

namespace {

bool isIdLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

}  // namespace

bool isServerId(std::string_view text) {
  return !text.empty() && text.size() <= kMaxServerId && isIdLetter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return isIdLetter(c) || c == '-'; });
}

std::string serverIdOf(std::string_view text) {
  std::string id;
  for (char c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    if (isIdLetter(c)) {
      id += c;
    } else if (!id.empty()) {
      id += '-';
    }
    if (id.size() == kMaxServerId) break;
  }
  return id.empty() ? "server" : id;
}

std::string presenceSubject(std::string_view id) {
  return "naiad.presence." + std::string(id);
}

std::string resultSubject(std::string_view id) {
  return "naiad.results." + std::string(id);
}

std::string sendOnSubject(std::string_view id) {
  return "naiad.sendon." + std::string(id);
}

}  // namespace naiad
