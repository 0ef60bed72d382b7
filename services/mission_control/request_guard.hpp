// Authorises requests by Host (against DNS rebinding), Origin and Sec-Fetch-Site (against cross-site request forgery),
// and token.
#pragma once

#include <optional>
#include <string>

#include "mission_control/http_message.hpp"

namespace rover::mission {

struct GuardConfig {
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string token;  // empty: not required; allowed only on a loopback address
};

// Header values used for authorisation; empty if absent.
struct RequestFacts {
  std::string method;
  std::string host;
  std::string origin;
  std::string fetch_site;
  std::string content_type;
  std::string token;  // from the cookie or the Authorization header
};

bool is_loopback(const std::string& address);
RequestCheck check_request(const GuardConfig& config, const RequestFacts& request);
RequestFacts facts_of(const Request& request);
// Constant-time comparison, against timing attacks.
bool same_secret(const std::string& a, const std::string& b);
// Value of one cookie in a Cookie header; empty if absent.
std::string cookie(const std::string& header, const std::string& name);

}  // namespace rover::mission
