// HTTP/1.1 server with bounded memory, connections and times: one request per connection, and streams that skip to the
// newest text for slow clients. Boost.Asio serves all connections in one thread; handlers run in thread pools.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "mission_control/http_message.hpp"
#include "mission_control/request_parser.hpp"

namespace rover::mission {

struct ServerLimits {
  RequestLimits request;
  // Concurrent. A further one replaces the oldest idle connection; if none is idle, it is closed.
  size_t connections = 64;
  std::chrono::milliseconds request_time{10'000};  // to receive a whole request; longer: 408
  std::chrono::milliseconds answer_time{30'000};   // to send a response; longer: closed
  std::chrono::milliseconds text_time{5'000};      // to send one text of a stream; longer: closed
  int send_buffer_bytes = 64 * 1024;               // in the kernel; small, to detect a stalled client soon
};

class HttpServer {
 public:
  using Handler = std::function<Response(const Request&)>;
  // Checks a request before its body is read, in the server's thread. A returned response replaces the handler's.
  using Admission = std::function<std::optional<Response>(const Request&)>;
  enum class Work {
    kShort,
    kBlocking,  // may block for seconds; runs in its own thread pool
  };

  // `headers` are added to every response.
  HttpServer(const ServerLimits& limits, Response::Headers headers, Admission admission);
  ~HttpServer();  // stops
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // Call before start().
  void get(const std::string& path, Handler handler);
  void post(const std::string& path, Handler handler, Work work = Work::kShort);

  // Starts the server threads; retries every second while the address is in use. `on_served` reports in the server's
  // thread whether the address is bound.
  void start(const std::string& address, int port, std::function<void(bool)> on_served);
  // Closes all connections and waits for the handlers.
  void stop();
  bool serving() const;

  // Call from any thread when the streams have new content.
  void wake_streams();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

Response json_response(int status, const nlohmann::json& body);
// {"accepted": false, "reason": REASON}
Response refusal(const RequestCheck& why);

}  // namespace rover::mission
