// What the gateway answers to a request for a file: a function of the request, the page and the settings.
//
// HTTP/1.1 (RFC 9110, 9112). Every answer has the headers that keep a browser from running, framing or
// leaking anything else than the page.
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
  std::string text;              ///< the body, of answers that are made
  std::string_view content;      ///< the body, of files: it belongs to PageFiles
  bool keeps_connection = true;  ///< another request may follow
  bool is_refusal = false;       ///< a status of 400 and more

  std::string_view body() const { return text.empty() ? content : std::string_view(text); }
};

/// What answers have in common. Immutable.
class HttpAnswers {
 public:
  /// `server_json`: for GET /server. `page` and `names` must outlive this.
  HttpAnswers(const PageFiles& page, const AllowedNames& names, std::string server_json, bool has_tls);

  /// To a request that was read, and is no WebSocket's.
  HttpAnswer answer(const WebRequest& request) const;
  /// A status with a sentence for people; the connection ends after it.
  HttpAnswer refusal(int status, std::string_view sentence) const;
  /// May this one become a WebSocket? Null if so, else the status and a sentence to refuse it with.
  struct Refusal {
    int status;
    std::string_view sentence;
  };
  const Refusal* judgeUpgrade(const WebRequest& request) const;

  using Header = std::pair<std::string_view, std::string_view>;
  /// Those of every answer.
  const std::vector<Header>& commonHeaders() const { return m_common; }
  /// The path of a request, without a query.
  static std::string_view pathOf(const WebRequest& request);

 private:
  /// As judgeUpgrade(), of every request.
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
