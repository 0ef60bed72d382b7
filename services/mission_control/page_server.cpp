#include "mission_control/page_server.hpp"

#include <httplib.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "mission_control/page_files.hpp"

namespace rover::mission {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

constexpr size_t kLargestBody = 64 * 1024;
constexpr auto kPatience = 3s;    // for the answer to a command
constexpr int kSpareThreads = 8;  // beside those that streams hold

// Nothing from elsewhere is loaded, and no other site may frame the page or read from it.
const httplib::Headers kHeaders = {
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; frame-ancestors 'none'; "
     "base-uri 'none'; form-action 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"X-Frame-Options", "DENY"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-cache"}};

std::string dumped(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// By way of a provider: the library would compress what it holds itself, for a second of processor time a page and
// nothing gained on a loopback.
void deliver(httplib::Response& response, std::shared_ptr<const std::string> content, const std::string& type) {
  if (content->empty()) return response.set_content("", type);
  response.set_content_provider(content->size(), type,
                                [content](size_t offset, size_t length, httplib::DataSink& sink) {
                                  return sink.write(content->data() + offset, length);
                                });
}

void deliver(httplib::Response& response, std::string content, const std::string& type) {
  deliver(response, std::make_shared<const std::string>(std::move(content)), type);
}

void answer(httplib::Response& response, int status, const json& body) {
  response.status = status;
  deliver(response, dumped(body), "application/json");
}

void refuse(httplib::Response& response, int status, const std::string& reason) {
  answer(response, status, {{"accepted", false}, {"reason", reason}});
}

void send(httplib::Response& response, const std::vector<std::uint8_t>& bytes, const char* type) {
  deliver(response, std::string(bytes.begin(), bytes.end()), type);
}

int status_of(Answer::Outcome outcome) {
  switch (outcome) {
    case Answer::Outcome::kAccepted:
      return 200;
    case Answer::Outcome::kRefused:
      return 409;
    case Answer::Outcome::kBusy:
      return 429;
    case Answer::Outcome::kNoTime:
      return 503;
    case Answer::Outcome::kSilence:
      return 504;
  }
  return 500;
}

std::string token_of(const httplib::Request& request) {
  static const std::string kBearer = "Bearer ";
  const std::string authorization = request.get_header_value("Authorization");
  if (authorization.rfind(kBearer, 0) == 0) return authorization.substr(kBearer.size());
  return cookie(request.get_header_value("Cookie"), "rover_token");
}

std::int64_t number_of(const httplib::Request& request, const char* key) {
  try {
    return request.has_param(key) ? std::stoll(request.get_param_value(key)) : 0;
  } catch (const std::exception&) {
    return 0;
  }
}

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

PageServer::PageServer(PageConfig config, PageContext context, Station& station, lcm::LCM& bus)
    : config_(std::move(config)),
      context_(std::move(context)),
      station_(station),
      ear_(bus, audience_, context_.services),
      broadcaster_(audience_, ear_, station_),
      map_(context_.run_dir, config_.path.slope, context_.rover_length_m),
      server_(std::make_unique<httplib::Server>()) {
  server_->set_default_headers(kHeaders);
  server_->set_payload_max_length(kLargestBody);
  server_->set_read_timeout(3s);
  server_->set_write_timeout(3s);
  server_->set_keep_alive_max_count(1);  // a connection that waits would hold a thread
  server_->set_tcp_nodelay(true);
  const int threads = config_.most_pages + kSpareThreads;
  server_->new_task_queue = [threads] { return new httplib::ThreadPool(static_cast<size_t>(threads)); };
  // The library's own would let two programs have the same port.
  server_->set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  add_routes();
}

PageServer::~PageServer() {
  running_ = false;
  audience_.end();
  broadcaster_.stop();
  for (bool stopped = false; !ended_;) {  // it may only be about to begin
    if (!stopped && server_->is_running()) {
      server_->stop();
      stopped = true;
    }
    std::this_thread::sleep_for(10ms);
  }
  if (thread_.joinable()) thread_.join();
}

void PageServer::start() {
  ended_ = false;
  thread_ = std::thread([this] { serve(); });
}

bool PageServer::serving() const {
  return server_->is_running();
}

void PageServer::serve() {
  while (running_) {
    if (server_->bind_to_port(config_.guard.address, config_.guard.port)) {
      station_.page_is_served = true;
      server_->listen_after_bind();
    }
    station_.page_is_served = false;
    for (int i = 0; i < 10 && running_; ++i) std::this_thread::sleep_for(100ms);
  }
  ended_ = true;
}

void PageServer::add_routes() {
  using Handled = httplib::Server::HandlerResponse;
  server_->set_pre_routing_handler([this](const Request& request, Response& response) {
    return greet(request, response) || !guard(request, response) ? Handled::Handled : Handled::Unhandled;
  });
  server_->set_exception_handler(
      [](const Request&, Response& response, std::exception_ptr) { refuse(response, 400, "not understood"); });
  server_->set_error_handler([](const Request&, Response& response) {
    if (!response.has_header("Content-Type"))
      refuse(response, response.status, "status " + std::to_string(response.status));
  });
  add_files();
  add_state();
  add_pictures();
  server_->Post("/api/command", [this](const Request& request, Response& response) { command(request, response); });
  server_->Post("/api/check", [this](const Request& request, Response& response) { check(request, response); });
}

// The token comes once with the address of the page; from then on the browser keeps it.
bool PageServer::greet(const Request& request, Response& response) const {
  const std::string& token = config_.guard.token;
  if (token.empty() || request.method != "GET" || request.path != "/" || !request.has_param("token")) return false;
  if (!same_secret(request.get_param_value("token"), token)) {
    refuse(response, 401, "not the token");
    return true;
  }
  response.set_header("Set-Cookie", "rover_token=" + token + "; HttpOnly; SameSite=Strict; Path=/");
  response.set_redirect("/", 303);
  return true;
}

bool PageServer::guard(const Request& request, Response& response) const {
  if (request.has_header("Range")) {  // a thousand overlapping ones would multiply the answer
    refuse(response, 400, "whole answers alone");
    return false;
  }
  const RequestFacts facts{request.method,
                           request.get_header_value("Host"),
                           request.get_header_value("Origin"),
                           request.get_header_value("Sec-Fetch-Site"),
                           request.get_header_value("Content-Type"),
                           token_of(request)};
  const Verdict verdict = judge(config_.guard, facts);
  if (verdict.status == 200) return true;
  refuse(response, verdict.status, verdict.reason);
  return false;
}

void PageServer::add_files() {
  for (const PageFile& file : page_files()) {
    server_->Get(file.path, [&file](const Request&, Response& response) {
      deliver(response, std::string(file.content), file.type);
    });
  }
  for (const LibraryFile& file : library_files()) {
    server_->Get("/lib" + file.path, [&file](const Request&, Response& response) {
      std::string content = content_of(file.file);
      if (content.empty()) return refuse(response, 404, file.file + " is missing: ./rover build installs it");
      deliver(response, std::move(content), file.type);
    });
  }
}

void PageServer::add_state() {
  server_->Get("/api/setup", [this](const Request&, Response& response) { answer(response, 200, setup()); });
  server_->Get("/api/history", [this](const Request&, Response& response) { answer(response, 200, history()); });
  server_->Get("/api/events", [this](const Request& request, Response& response) {
    const std::int64_t after = number_of(request, "after");
    answer(response, 200, station_.book.with([after](const Logbook& book) { return book.events_after(after); }));
  });
  server_->Get("/api/paths", [this](const Request&, Response& response) {
    const LocalPathView local = ear_.with([](const Gatherer& gatherer) { return gatherer.path(); });
    json global = station_.book.with([](const Logbook& book) { return book.path_json(); });
    answer(response, 200,
           {{"global", global},
            {"local", {{"id", local.id}, {"kind", local.kind}, {"x_m", local.x_m}, {"y_m", local.y_m}}}});
  });
  server_->Get("/api/camera", [this](const Request&, Response& response) {
    const auto camera = ear_.with([](const Gatherer& gatherer) { return gatherer.camera(); });
    if (!camera) return answer(response, 200, nullptr);
    json rotation = json::array();
    const Eigen::Matrix3d R = camera->T_body_cam.rotation();
    for (int row = 0; row < 3; ++row) rotation.push_back({R(row, 0), R(row, 1), R(row, 2)});
    const Eigen::Vector3d p = camera->T_body_cam.translation();
    answer(response, 200,
           {{"width", camera->width},
            {"height", camera->height},
            {"focal_px", camera->focal_px},
            {"cx_px", camera->cx_px},
            {"cy_px", camera->cy_px},
            {"position_m", {p.x(), p.y(), p.z()}},
            {"rotation", rotation}});
  });
  server_->Get("/api/stream", [this](const Request& request, Response& response) { stream(request, response); });
}

void PageServer::add_pictures() {
  server_->Get(R"(/layer/(hazards|traversability|elevation)\.png)", [this](const Request& request, Response& response) {
    const std::string name = request.matches[1];
    const auto content = ear_.with([&](const Gatherer& gatherer) { return gatherer.grid(name); });
    if (!content) return refuse(response, 404, "not heard yet");
    send(response, *pictures_.grid(name, *content), "image/png");
  });
  server_->Get(R"(/camera/(loccam|navcam)\.jpg)", [this](const Request& request, Response& response) {
    const std::string name = request.matches[1];
    const auto image = ear_.with([&](const Gatherer& gatherer) { return gatherer.image(name); });
    if (!image) return refuse(response, 404, "not heard yet");
    send(response, *pictures_.camera(name, *image), "image/jpeg");
  });
  server_->Get(R"(/map/(relief|slope|difficulty))", [this](const Request& request, Response& response) {
    const std::string name = request.matches[1];
    const auto picture = map_.picture(name);
    if (!picture) return refuse(response, 404, "there is no orbital map");
    send(response, *picture, name == "relief" ? "image/jpeg" : "image/png");
  });
}

nlohmann::json PageServer::setup() {
  json out = context_.setup;
  out["run"] = context_.run_name;
  out["injection"] = context_.allow_injection;
  out["services"] = context_.services;
  const GroundMap* map = map_.get();
  out["map"] =
      map == nullptr
          ? json()
          : json{{"width_m", map->width_m()}, {"height_m", map->height_m()}, {"resolution_m", map->resolution_m()}};
  out["path"] = {{"corridor_half_width_m", config_.path.corridor_half_width_m},
                 {"warn_slope_deg", std::round(1e6 * to_deg(config_.path.slope.warn_rad)) * 1e-6},
                 {"most_slope_deg", std::round(1e6 * to_deg(config_.path.slope.most_rad)) * 1e-6},
                 {"longest_m", config_.path.longest_m},
                 {"most_points", config_.path.limits.most_points}};
  return out;
}

nlohmann::json PageServer::history() {
  return station_.book.with([](const Logbook& book) {
    return json{{"track", book.track()},
                {"events", book.events_after(0)},
                {"path", book.path_json()},
                {"trend", book.trend_json()}};
  });
}

void PageServer::stream(const Request& request, Response& response) {
  const bool truth = request.get_param_value("truth") == "1";
  if (!audience_.enter(truth, config_.most_pages)) return refuse(response, 503, "too many pages are open");
  const auto number = std::make_shared<std::int64_t>(0);
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, truth, number](size_t, httplib::DataSink& sink) {
        const auto frame = broadcaster_.after(*number);
        if (broadcaster_.stopped()) return false;
        if (!frame) return sink.write(":\n\n", 3);  // tells whether the page is still there
        *number = frame->number;
        const bool sent = sink.write(frame->view.data(), frame->view.size());
        return sent && (!truth || frame->truth.empty() || sink.write(frame->truth.data(), frame->truth.size()));
      },
      [this, truth](bool) { audience_.leave(truth); });
}

void PageServer::command(const Request& request, Response& response) {
  const ParsedCommand parsed = parse_command(request.body, config_.path.limits);
  if (!parsed.command) return refuse(response, 400, parsed.error);
  if (is_injection(parsed.command->kind)) return inject(*parsed.command, response);
  if (parsed.command->kind == CommandKind::kPath)
    if (const std::string problem = path_problem(*parsed.command); !problem.empty())
      return refuse(response, 422, problem);
  give(*parsed.command, response);
}

void PageServer::give(const Command& command, Response& response) {
  const Answer given = station_.desk.give(command, kPatience);
  const bool accepted = given.outcome == Answer::Outcome::kAccepted;
  answer(response, status_of(given.outcome),
         {{"accepted", accepted}, {"reason", given.reason}, {"command_id", given.command_id}});
}

void PageServer::inject(const Command& command, Response& response) {
  if (!context_.allow_injection)
    return refuse(response, 403, "this run was started without injection: ./rover run --allow-injection");
  const auto& names = context_.services;
  if (std::find(names.begin(), names.end(), command.target) == names.end())
    return refuse(response, 422, command.target + " is not a service");
  const bool done = context_.inject(command.target, command.kind);
  station_.book.with([&](Logbook& book) {
    book.note(station_.now_s, done ? Tone::kWarn : Tone::kInfo, "command",
              description(command) + (done ? " done" : " was not possible"));
  });
  if (!done) return refuse(response, 409, "not possible: s6 does not keep this service");
  answer(response, 200, {{"accepted", true}, {"reason", ""}});
}

// An operator's path goes over ground that the map knows and a rover can climb.
std::string PageServer::path_problem(const Command& command) {
  const GroundMap* map = map_.get();
  if (map == nullptr) return "there is no orbital map to check the path against";
  const PathCheck found = map->check(command.points);
  if (!found.inside) return "the path leaves the map";
  char text[96];
  std::snprintf(text, sizeof text, "the path is %.0f m long, more than %.0f m", found.length_m, config_.path.longest_m);
  if (found.length_m > config_.path.longest_m) return text;
  std::snprintf(text, sizeof text, "slope of %.1f deg on the path, more than %.1f deg", to_deg(found.max_slope_rad),
                to_deg(config_.path.slope.most_rad));
  return found.passable ? "" : text;
}

void PageServer::check(const Request& request, Response& response) {
  const ParsedPoints parsed = parse_points(request.body, config_.path.limits);
  if (!parsed.error.empty()) return refuse(response, 400, parsed.error);
  const GroundMap* map = map_.get();
  if (map == nullptr) return refuse(response, 422, "there is no orbital map to check the path against");
  PathCheck found = map->check(parsed.points);
  for (double& slope : found.slope_rad) slope = to_deg(slope);
  answer(response, 200,
         {{"inside", found.inside},
          {"passable", found.passable},
          {"length_m", found.length_m},
          {"max_slope_deg", to_deg(found.max_slope_rad)},
          {"distance_m", found.distance_m},
          {"slope_deg", found.slope_rad},
          {"height_m", found.height_m}});
}

}  // namespace rover::mission
