#include "mission_control/request_guard.hpp"

#include <array>

namespace rover::mission {
namespace {

constexpr std::array kLoopback = {"127.0.0.1", "localhost", "::1"};

std::string with_port(const std::string& address, int port) {
  const bool v6 = address.find(':') != std::string::npos;
  return (v6 ? "[" + address + "]" : address) + ":" + std::to_string(port);
}

// With a token any Host is accepted, because another site's page does not have the cookie.
bool host_is_ours(const GuardConfig& config, const std::string& host) {
  if (!config.token.empty()) return !host.empty();
  for (const char* name : kLoopback)
    if (host == with_port(name, config.port)) return true;
  return false;
}

RequestCheck check_state_change(const RequestFacts& request) {
  if (request.origin != "http://" + request.host) return {403, "the request comes from another page (Origin)"};
  if (!request.fetch_site.empty() && request.fetch_site != "same-origin")
    return {403, "the request comes from another page (Sec-Fetch-Site)"};
  if (request.content_type.rfind("application/json", 0) != 0) return {415, "Content-Type must be application/json"};
  return {};
}

}  // namespace

bool is_loopback(const std::string& address) {
  for (const char* name : kLoopback)
    if (address == name) return true;
  return false;
}

RequestCheck check_request(const GuardConfig& config, const RequestFacts& request) {
  if (!host_is_ours(config, request.host)) return {403, "Host is not the address of this page"};
  if (!config.token.empty() && !same_secret(request.token, config.token))
    return {401, "a token is required; open the page once as /?token=..."};
  if (request.method == "GET") return {};
  if (request.method == "POST") return check_state_change(request);
  return {405, "only GET and POST are supported"};
}

RequestFacts facts_of(const Request& request) {
  static const std::string kBearer = "Bearer ";
  const std::string authorization = request.header("authorization");
  return {request.method,
          request.header("host"),
          request.header("origin"),
          request.header("sec-fetch-site"),
          request.header("content-type"),
          authorization.rfind(kBearer, 0) == 0 ? authorization.substr(kBearer.size())
                                               : cookie(request.header("cookie"), "rover_token")};
}

bool same_secret(const std::string& a, const std::string& b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (size_t i = 0; i < b.size(); ++i)
    difference |= static_cast<unsigned char>(b[i]) ^ static_cast<unsigned char>(i < a.size() ? a[i] : 0);
  return difference == 0;
}

std::string cookie(const std::string& header, const std::string& name) {
  const std::string key = name + "=";
  for (size_t at = 0; at < header.size();) {
    size_t end = header.find(';', at);
    if (end == std::string::npos) end = header.size();
    while (at < end && header[at] == ' ') ++at;
    if (header.compare(at, key.size(), key) == 0) return header.substr(at + key.size(), end - at - key.size());
    at = end + 1;
  }
  return "";
}

}  // namespace rover::mission
