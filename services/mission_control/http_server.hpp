// A small HTTP/1.1 server whose memory, connections and times are bounded for whatever is sent: one request a
// connection, answers from memory, and streams of which each client gets the newest text when it has taken the one
// before. Boost.Asio serves all connections in one thread; handlers run in a few others.
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
  // At a time. One more takes the place of the oldest that is not at work for anybody, or is closed.
  size_t connections = 64;
  std::chrono::milliseconds request_time{10'000};  // for a whole request to come; longer: 408
  std::chrono::milliseconds answer_time{30'000};   // for an answer to be taken; longer: closed
  std::chrono::milliseconds text_time{5'000};      // for one text of a stream to be taken; longer: closed
  int send_buffer_bytes = 64 * 1024;               // in the kernel, so that a stalled client is soon seen
};

class HttpServer {
 public:
  using Handler = std::function<Response(const Request&)>;
  // Looks at a request before its body is read, in the server's own thread: its answer, where the request is not for a
  // handler.
  using Admission = std::function<std::optional<Response>(const Request&)>;
  enum class Work {
    kShort,
    kWaits,  // for seconds, for somebody: in threads of its own, so that the others need not wait for it
  };

  // `headers`: of every answer.
  HttpServer(const ServerLimits& limits, Response::Headers headers, Admission admission);
  ~HttpServer();  // stops
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  // Before start().
  void get(const std::string& path, Handler handler);
  void post(const std::string& path, Handler handler, Work work = Work::kShort);

  // Serves in threads of its own. Where the address is not to be had it is tried again each second. `on_served`:
  // whether it is being served, in the server's thread.
  void start(const std::string& address, int port, std::function<void(bool)> on_served);
  // Closes all connections and waits for the handlers.
  void stop();
  bool serving() const;

  // There is something new for the streams. From any thread.
  void wake_streams();

 private:
  class Serving;
  std::unique_ptr<Serving> serving_;
};

Response json_response(int status, const nlohmann::json& body);
// {"accepted": false, "reason": REASON}
Response refusal(const Verdict& why);

}  // namespace rover::mission
