// The gateway's answers to HTTP requests. An answer depends only on the request, the page and the settings.
//
// HTTP/1.1 (RFC 9110, 9112). Every answer has the headers that keep a browser from running foreign scripts,
// and from framing or leaking the page.
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/gateway/AllowedNames.h"
#include "server/gateway/PageFiles.h"
#include "shared/net/base/WebDoor.h"

namespace naiad {

using WebRequest = boost::beast::http::request<boost::beast::http::empty_body>;

struct HttpAnswer {
  std::string head;              ///< status line and headers, with the empty line
  std::string text;              ///< body of a generated answer
  std::string_view content;      ///< body of a file, owned by PageFiles
  bool keeps_connection = true;  ///< another request may follow
  bool is_refusal = false;       ///< status 400 or above

  std::string_view body() const { return text.empty() ? content : std::string_view(text); }
};

/// Makes the answers of a gateway. Immutable.
class HttpAnswers {
 public:
  /// `server_json`: answer to GET /server. `page` and `names` must outlive this.
  HttpAnswers(const PageFiles& page, const AllowedNames& names, std::string server_json, bool has_tls);

  /// Returns the answer to a request that is not a WebSocket upgrade.
  HttpAnswer answer(const WebRequest& request) const;
  /// Returns an error with a message; the connection ends after it.
  HttpAnswer refusal(int status, std::string_view sentence) const;
  /// The status and message of a refused request.
  struct Refusal {
    int status;
    std::string_view sentence;
  };
  /// Returns null if the request may become a WebSocket, else the refusal.
  const Refusal* judgeUpgrade(const WebRequest& request) const;

  using Header = std::pair<std::string_view, std::string_view>;
  /// Returns the headers that every answer has.
  const std::vector<Header>& commonHeaders() const { return m_common; }
  /// Returns the path of a request, without its query.
  static std::string_view pathOf(const WebRequest& request);

 private:
  /// Like judgeUpgrade(), for the checks of every request: HTTP version and Host.
  const Refusal* judgeHost(const WebRequest& request) const;
  HttpAnswer fileAnswer(const WebRequest& request, const PageFile& file) const;
  HttpAnswer make(const WebRequest& request, int status, std::string_view headers,
                  std::string_view body) const;

  const PageFiles& m_page;
  const AllowedNames& m_names;
  std::string m_server_json;
  std::vector<Header> m_common;
  std::string m_common_text;
};

}  // namespace naiad
