// HTTP request and response types, independent of sockets.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace rover::mission {

struct Request {
  std::string method;
  std::string path;                            // percent-decoded, without the query
  std::map<std::string, std::string> params;   // query, percent-decoded; first value of each name
  std::map<std::string, std::string> headers;  // names in lower case; repeated headers are joined with ", "
  std::string body;

  // Empty if absent. `name` in lower case.
  std::string header(const std::string& name) const { return value(headers, name); }
  std::string param(const std::string& name) const { return value(params, name); }

 private:
  static std::string value(const std::map<std::string, std::string>& from, const std::string& name) {
    const auto it = from.find(name);
    return it == from.end() ? "" : it->second;
  }
};

// HTTP status and reason; 200: accepted.
struct RequestCheck {
  int status = 200;
  std::string reason;
};

// Bytes and their owner; a null owner means static storage.
struct Content {
  std::string_view bytes;
  std::shared_ptr<const void> owner;

  static Content of(std::string text) {
    auto owner = std::make_shared<const std::string>(std::move(text));
    return {*owner, owner};
  }
};

struct Response {
  using Headers = std::vector<std::pair<std::string, std::string>>;

  int status = 200;
  std::string type;  // Content-Type; empty: none
  Content content;
  Headers headers;
  // If set, the response is a stream of what this returns, until the client disconnects. It runs in the server's
  // thread, so it must not block. Empty content: nothing new.
  std::function<Content()> next;
};

}  // namespace rover::mission
