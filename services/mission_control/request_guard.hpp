// Who may ask for what: the address a request came to, the page it came from, the token it brings.
//
// A browser sends requests for any web site that the operator has open. Those carry the address the browser was made to
// use (Host: another name that leads here, "DNS rebinding"), and where a request can change something also the site it
// comes from (Origin, Sec-Fetch-Site). Both have to be the page's own.
#pragma once

#include <optional>
#include <string>

#include "mission_control/http_message.hpp"

namespace rover::mission {

struct GuardConfig {
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string token;  // empty: none is asked for, which a loopback address alone may have
};

// What the guard looks at; empty where the request has no such header.
struct RequestFacts {
  std::string method;
  std::string host;
  std::string origin;
  std::string fetch_site;
  std::string content_type;
  std::string token;  // from the cookie or the Authorization header
};

bool is_loopback(const std::string& address);
Verdict judge(const GuardConfig& config, const RequestFacts& request);
RequestFacts facts_of(const Request& request);
// In a time that does not tell how much of it was right.
bool same_secret(const std::string& a, const std::string& b);
// Value of one cookie of a Cookie header, empty where there is none.
std::string cookie(const std::string& header, const std::string& name);

}  // namespace rover::mission
