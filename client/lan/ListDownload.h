// Downloads a list of servers from the web, over HTTPS (shared/net/http/HttpExchange.h).
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <variant>

#include "client/lan/ListUrl.h"

namespace naiad {

/// Why there is no list: a sentence for people, without anything from the other end in it.
struct DownloadProblem {
  std::string sentence;
};

inline constexpr std::size_t kMaxListBytes = std::size_t{1} << 20;
inline constexpr std::chrono::seconds kListPatience{5};  ///< for all of it, redirects too
inline constexpr int kMaxListRedirects = 3;

/// Waits for the list. The certificate must be good in the eyes of the system's trust store. A redirect is
/// followed as far as ListUrl::redirected() goes.
std::variant<std::string, DownloadProblem> downloadList(const ListUrl& url);

}  // namespace naiad
