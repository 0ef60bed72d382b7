#include "tools/launcher/s6_tree.hpp"

#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "common/bus/config.hpp"

namespace rover {
namespace fs = std::filesystem;
namespace {

void write_script(const fs::path& file, const std::string& text) {
  std::ofstream out(file);
  out << "#!/bin/sh\n" << text;
  out.close();
  if (!out) throw ConfigError(file.string() + ": cannot be written");
  fs::permissions(file, fs::perms::owner_exec, fs::perm_options::add);
}

// Each start increments boot_id, which separates the streams of successive processes.
std::string run_script(const ServiceCommand& service, bool allow_injection) {
  const std::string boots = "boots/" + service.name;
  return "cd \"$ROVER_RUN\" || exit 1\nexec 2>&1\nBOOT=$(( $(cat " + boots +
         " 2>/dev/null || echo 0) + 1 ))\necho $BOOT > " + boots + "\nexec \"$ROVER_BIN/" + service.name +
         "\" --config \"$ROVER_RUN/config\" --bus \"$ROVER_BUS\" --run-dir \"$ROVER_RUN\" " + service.flags +
         (allow_injection ? " --allow-injection" : "") + " --boot-id $BOOT\n";
}

// Exit 125 tells s6 not to restart: after bad configuration (2) or a clean exit of a run-once service. s6 waits 1 s
// before a restart; a service that was up for 2 s is restarted at once.
std::string finish_script(const ServiceCommand& service) {
  const std::string dir = "services/" + service.name;
  return "cd \"$ROVER_RUN\" || exit 0\necho \"$1 $2\" >> exits/" + service.name + "\n[ \"$1\" = 2 ] && exit 125\n" +
         (service.once ? "[ \"$1\" = 0 ] && exit 125\n" : "") + "[ -n \"$(find boots/" + service.name +
         " -newermt '-2 seconds')\" ] && exit 0\n(sleep 0.02; [ \"$(s6-svstat -o wantedup " + dir +
         ")\" = true ] && exec s6-svc -u " + dir + ") >/dev/null 2>&1 &\nexit 0\n";
}

std::string last_line(const fs::path& file) {
  std::ifstream in(file);
  std::string last;
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace

void write_s6_tree(const std::string& run_dir, const std::vector<ServiceCommand>& services, bool allow_injection) {
  const fs::path root(run_dir);
  fs::create_directories(root / "boots");
  fs::create_directories(root / "exits");
  for (const ServiceCommand& service : services) {
    const fs::path dir = root / "services" / service.name;
    fs::create_directories(dir / "log");
    write_script(dir / "run", run_script(service, allow_injection));
    write_script(dir / "finish", finish_script(service));
    write_script(dir / "log" / "run", "exec s6-log -b n3 s2000000 \"$ROVER_RUN/service_logs/" + service.name + "\"\n");
    fs::create_directories(root / "service_logs" / service.name);
  }
}

S6Session::S6Session(const RunFolder& folder, const std::string& bin_dir) {
  const std::string scan = folder.dir + "/services";
  const std::string own_log = folder.dir + "/service_logs/s6.log";
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) {
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) _exit(1);
    setpgid(0, 0);  // so that Ctrl-C reaches only the launcher, which stops the services in order
    setenv("ROVER_BIN", bin_dir.c_str(), 1);
    setenv("ROVER_RUN", folder.dir.c_str(), 1);
    setenv("ROVER_BUS", folder.bus_url.c_str(), 1);
    if (freopen(own_log.c_str(), "w", stderr) == nullptr || freopen("/dev/null", "r", stdin) == nullptr) _exit(1);
    execlp("s6-svscan", "s6-svscan", scan.c_str(), nullptr);
    _exit(127);
  }
  if (pid_ < 0) throw ConfigError("s6-svscan: cannot be started");
}

S6Session::~S6Session() {
  stop();
}

bool S6Session::running() {
  return pid_ > 0 && waitpid(pid_, nullptr, WNOHANG) == 0;
}

void S6Session::stop() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  constexpr int kTimeoutMs = 10'000;
  for (int waited = 0; waited < kTimeoutMs; waited += 10) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) {
      pid_ = -1;
      return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

std::vector<FailedService> failed_services(const std::string& run_dir) {
  std::vector<FailedService> failed;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(fs::path(run_dir) / "exits", error)) {
    const std::string name = entry.path().filename();
    if (last_line(entry.path()).rfind("2 ", 0) != 0) continue;
    failed.push_back({name, last_line(fs::path(run_dir) / "service_logs" / name / "current")});
  }
  std::sort(failed.begin(), failed.end(), [](const FailedService& a, const FailedService& b) {
    return std::pair(a.last_log_line.empty(), a.name) < std::pair(b.last_log_line.empty(), b.name);
  });
  return failed;
}

}  // namespace rover
