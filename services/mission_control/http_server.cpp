#include "mission_control/http_server.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <list>
#include <nlohmann/json.hpp>
#include <thread>

namespace rover::mission {
namespace {

namespace net = boost::asio;
using namespace std::chrono_literals;
using boost::system::error_code;
using boost::system::system_error;
using net::ip::tcp;

constexpr int kShortThreads = 2;  // bounds the processor share of valid requests, in addition to the server's thread
constexpr int kBlockingThreads = 24;
constexpr int kNice = 10;  // low priority, so that a flood of connections does not slow the drive
constexpr size_t kReadBytes = 8 * 1024;
constexpr auto kPause = 1s;  // before retrying bind or accept; between keep-alives of a stream
constexpr auto kLingerTime = 1s;
constexpr size_t kLingerBytes = 256 * 1024;

struct Connection : std::enable_shared_from_this<Connection> {
  explicit Connection(tcp::socket from)
      : socket(std::move(from)), deadline(socket.get_executor()), wake_timer(socket.get_executor()) {}

  // After the deadline pending socket operations fail and `late` is set.
  void set_deadline(std::chrono::milliseconds time) {
    late = false;
    deadline.expires_after(time);
    deadline.async_wait([self = shared_from_this()](const error_code& error) {
      if (error || self->deadline.expiry() > std::chrono::steady_clock::now()) return;
      self->late = true;
      self->socket.cancel();
    });
  }
  void close() {
    error_code ignored;
    socket.close(ignored);
    deadline.cancel();
    wake_timer.cancel();
  }

  tcp::socket socket;
  net::steady_timer deadline;
  net::steady_timer wake_timer;  // cancelled when its stream has new content
  bool received_any = false;
  bool late = false;
  bool busy = false;  // running a handler or a stream
};

std::string head_of(const Response& response, const Response::Headers& common) {
  std::string out = "HTTP/1.1 " + std::to_string(response.status) + " \r\nConnection: close\r\n";
  const auto add = [&out](const std::string& name, const std::string& value) { out += name + ": " + value + "\r\n"; };
  for (const auto& [name, value] : common) add(name, value);
  for (const auto& [name, value] : response.headers) add(name, value);
  if (!response.type.empty()) add("Content-Type", response.type);
  if (!response.next) add("Content-Length", std::to_string(response.content.bytes.size()));
  return out + "\r\n";
}

}  // namespace

class HttpServer::Impl {
 public:
  struct Route {
    Handler handler;
    Work work = Work::kShort;
  };

  Impl(const ServerLimits& limits, Response::Headers headers, Admission admission)
      : limits_(limits), headers_(std::move(headers)), admission_(std::move(admission)) {}
  ~Impl() { stop(); }

  void add(const std::string& what, Route route) { routes_[what] = std::move(route); }
  bool served() const { return served_; }
  void start(const std::string& address, int port, std::function<void(bool)> on_served);
  void stop();
  void wake_streams();

 private:
  using Client = std::shared_ptr<Connection>;

  net::awaitable<void> listen(std::string address, std::string port);
  bool bind(const std::string& address, const std::string& port);
  void report_served(bool served);
  net::awaitable<void> pause();
  net::awaitable<void> accept();
  bool make_room();
  net::awaitable<void> serve(Client client);
  net::awaitable<void> answer(Connection& client);
  net::awaitable<Response> answer_to(Connection& client);
  net::awaitable<void> read_more(Connection& client, RequestParser& parser);
  net::awaitable<Response> handle(const Request& request);
  net::awaitable<void> send(Connection& client, const Response& response);
  net::awaitable<void> stream(Connection& client, const std::function<Content()>& next);
  net::awaitable<void> linger(Connection& client);

  ServerLimits limits_;
  Response::Headers headers_;
  Admission admission_;
  std::map<std::string, Route> routes_;  // by method and path
  std::function<void(bool)> on_served_;
  std::atomic<bool> served_ = false;
  // Members below are used only in the thread of io_.
  net::io_context io_{1};
  tcp::acceptor acceptor_{io_};
  net::steady_timer pause_{io_};
  std::list<Client> connections_;  // oldest first
  bool stopping_ = false;
  net::thread_pool short_pool_{kShortThreads};
  net::thread_pool blocking_pool_{kBlockingThreads};
  std::thread thread_;
};

void HttpServer::Impl::start(const std::string& address, int port, std::function<void(bool)> on_served) {
  on_served_ = std::move(on_served);
  net::co_spawn(io_, listen(address, std::to_string(port)), net::detached);
  thread_ = std::thread([this] {
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
    io_.run();
  });
}

void HttpServer::Impl::stop() {
  if (!thread_.joinable()) return;
  net::post(io_, [this] {
    stopping_ = true;
    error_code ignored;
    acceptor_.close(ignored);
    pause_.cancel();
    for (const Client& client : connections_) client->close();
  });
  thread_.join();
}

void HttpServer::Impl::wake_streams() {
  net::post(io_, [this] {
    for (const Client& client : connections_) client->wake_timer.cancel();
  });
}

net::awaitable<void> HttpServer::Impl::listen(std::string address, std::string port) {
  while (!stopping_) {
    report_served(bind(address, port));
    if (served_) co_await accept();
    if (!stopping_) co_await pause();
  }
  report_served(false);
}

bool HttpServer::Impl::bind(const std::string& address, const std::string& port) {
  error_code error;
  for (const auto& found : tcp::resolver(io_).resolve(address, port, tcp::resolver::passive, error)) {
    try {
      acceptor_ = tcp::acceptor(io_, found.endpoint().protocol());
      acceptor_.set_option(tcp::acceptor::reuse_address(true));
      acceptor_.set_option(net::socket_base::send_buffer_size(limits_.send_buffer_bytes));
      acceptor_.bind(found.endpoint());
      acceptor_.listen();
      return true;
    } catch (const system_error&) {  // address in use
    }
  }
  return false;
}

void HttpServer::Impl::report_served(bool served) {
  served_ = served;
  on_served_(served);
}

net::awaitable<void> HttpServer::Impl::pause() {
  error_code ended;
  pause_.expires_after(kPause);
  co_await pause_.async_wait(net::redirect_error(net::use_awaitable, ended));
}

net::awaitable<void> HttpServer::Impl::accept() {
  while (!stopping_) {
    error_code error;
    tcp::socket socket = co_await acceptor_.async_accept(net::redirect_error(net::use_awaitable, error));
    if (stopping_) break;
    if (error) {  // no file descriptor left; pause to avoid a busy loop
      co_await pause();
      continue;
    }
    if (!make_room()) continue;
    socket.set_option(tcp::no_delay(true), error);
    connections_.push_back(std::make_shared<Connection>(std::move(socket)));
    net::co_spawn(io_, serve(connections_.back()), net::detached);
  }
}

bool HttpServer::Impl::make_room() {
  if (connections_.size() < limits_.connections) return true;
  const auto oldest = std::find_if(connections_.begin(), connections_.end(), [](const Client& c) { return !c->busy; });
  if (oldest == connections_.end()) return false;
  (*oldest)->close();
  connections_.erase(oldest);
  return true;
}

net::awaitable<void> HttpServer::Impl::serve(Client client) {
  try {
    co_await answer(*client);
    co_await linger(*client);
  } catch (const std::exception&) {  // disconnected or timed out
  }
  client->close();
  connections_.remove(client);
}

net::awaitable<void> HttpServer::Impl::answer(Connection& client) {
  const Response response = co_await answer_to(client);
  client.busy = response.next != nullptr;
  co_await send(client, response);
  if (response.next) co_await stream(client, response.next);
}

net::awaitable<Response> HttpServer::Impl::answer_to(Connection& client) {
  using State = RequestParser::State;
  RequestParser parser(limits_.request);
  client.set_deadline(limits_.request_time);
  while (parser.state() == State::kHeader) co_await read_more(client, parser);
  if (parser.state() == State::kRefused) co_return refusal(parser.refusal());
  if (std::optional<Response> refused = admission_(parser.request())) co_return std::move(*refused);
  if (parser.state() == State::kBody && !parser.request().header("expect").empty())
    co_await net::async_write(client.socket, net::buffer("HTTP/1.1 100 \r\n\r\n", 17), net::use_awaitable);
  while (parser.state() == State::kBody) co_await read_more(client, parser);
  if (parser.state() == State::kRefused) co_return refusal(parser.refusal());
  client.deadline.cancel();
  client.busy = true;
  co_return co_await handle(parser.request());
}

net::awaitable<void> HttpServer::Impl::read_more(Connection& client, RequestParser& parser) {
  std::array<char, kReadBytes> bytes;
  error_code error;
  const size_t count =
      co_await client.socket.async_read_some(net::buffer(bytes), net::redirect_error(net::use_awaitable, error));
  if (error && !client.received_any) throw system_error(error);  // browsers connect in advance without a request
  client.received_any = true;
  if (error)
    parser.end(client.late ? RequestCheck{408, "the request took too long"}
                           : RequestCheck{400, "the request is incomplete"});
  else
    parser.feed({bytes.data(), count});
}

net::awaitable<Response> HttpServer::Impl::handle(const Request& request) {
  const auto found = routes_.find(request.method + " " + request.path);
  if (found == routes_.end()) co_return refusal({404, "not found"});
  const Route& route = found->second;
  const auto run = [&]() -> net::awaitable<Response> { co_return route.handler(request); };
  net::thread_pool& threads = route.work == Work::kBlocking ? blocking_pool_ : short_pool_;
  try {
    co_return co_await net::co_spawn(threads.get_executor(), run, net::use_awaitable);
  } catch (const std::exception& problem) {
    co_return refusal({500, problem.what()});
  }
}

net::awaitable<void> HttpServer::Impl::send(Connection& client, const Response& response) {
  client.set_deadline(limits_.answer_time);
  const std::string head = head_of(response, headers_);
  const std::array<net::const_buffer, 2> all{net::buffer(head), net::buffer(response.content.bytes)};
  co_await net::async_write(client.socket, all, net::use_awaitable);
}

net::awaitable<void> HttpServer::Impl::stream(Connection& client, const std::function<Content()>& next) {
  static constexpr std::string_view kKeepAlive = ":\n\n";  // SSE comment; detects a closed connection
  while (!stopping_) {
    Content text = next();
    if (text.bytes.empty()) {
      error_code woken;
      client.deadline.cancel();
      client.wake_timer.expires_after(kPause);
      co_await client.wake_timer.async_wait(net::redirect_error(net::use_awaitable, woken));
      text = next();
    }
    client.set_deadline(limits_.text_time);
    co_await net::async_write(client.socket, net::buffer(text.bytes.empty() ? kKeepAlive : text.bytes),
                              net::use_awaitable);
  }
}

// Reads the remaining input first, because closing a socket with unread bytes resets it and loses the response.
net::awaitable<void> HttpServer::Impl::linger(Connection& client) {
  client.socket.shutdown(tcp::socket::shutdown_send);
  client.set_deadline(kLingerTime);
  std::array<char, kReadBytes> bytes;
  for (size_t count = 0; count < kLingerBytes;)
    count += co_await client.socket.async_read_some(net::buffer(bytes), net::use_awaitable);
}

HttpServer::HttpServer(const ServerLimits& limits, Response::Headers headers, Admission admission)
    : impl_(std::make_unique<Impl>(limits, std::move(headers), std::move(admission))) {}

HttpServer::~HttpServer() = default;

void HttpServer::get(const std::string& path, Handler handler) {
  impl_->add("GET " + path, {std::move(handler)});
}

void HttpServer::post(const std::string& path, Handler handler, Work work) {
  impl_->add("POST " + path, {std::move(handler), work});
}

void HttpServer::start(const std::string& address, int port, std::function<void(bool)> on_served) {
  impl_->start(address, port, std::move(on_served));
}

void HttpServer::stop() {
  impl_->stop();
}

bool HttpServer::serving() const {
  return impl_->served();
}

void HttpServer::wake_streams() {
  impl_->wake_streams();
}

Response json_response(int status, const nlohmann::json& body) {
  return {status,
          "application/json",
          Content::of(body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)),
          {},
          {}};
}

Response refusal(const RequestCheck& why) {
  Response out = json_response(why.status, {{"accepted", false}, {"reason", why.reason}});
  if (why.status == 405) out.headers = {{"Allow", "GET, POST"}};
  return out;
}

}  // namespace rover::mission
