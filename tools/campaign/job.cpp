#include "tools/campaign/job.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/bus/config.hpp"

namespace rover::campaign {
namespace {

using Json = nlohmann::json;

std::string jobs_file(const std::string& dir) {
  return dir + "/jobs.jsonl";
}

Job parse_job(const std::string& line, const std::string& where) try {
  const Json json = Json::parse(line);
  Job job;
  job.cell = json.at("cell").get<Cell>();
  json.at("seed").get_to(job.seed);
  json.at("scenario").get_to(job.scenario);
  json.at("level").get_to(job.level);
  json.at("perception").get_to(job.perception);
  json.at("set").get_to(job.set);
  return job;
} catch (const Json::exception& error) {
  throw ConfigError(where + ": not a job of a campaign: " + error.what());
}

}  // namespace

bool is_rendered(const Job& job) {
  return job.perception.empty() || job.perception == "rendered";
}

std::string shell_word(const std::string& word) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,+@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::vector<Job> read_jobs(const std::string& dir) {
  std::ifstream in(jobs_file(dir));
  if (!in) throw ConfigError(dir + ": not the folder of a campaign: no jobs.jsonl");
  std::vector<Job> jobs;
  for (std::string line; std::getline(in, line);)
    jobs.push_back(parse_job(line, jobs_file(dir) + ":" + std::to_string(jobs.size() + 1)));
  return jobs;
}

Job read_job(const std::string& dir, int number) {
  std::ifstream in(jobs_file(dir));
  std::string line;
  for (int i = 0; i < number; ++i)
    if (!std::getline(in, line)) throw ConfigError(jobs_file(dir) + ": no job " + std::to_string(number));
  return parse_job(line, jobs_file(dir) + ":" + std::to_string(number));
}

void write_jobs(const std::string& dir, const std::vector<Job>& jobs) {
  std::ofstream out(jobs_file(dir));
  for (const Job& job : jobs)
    out << Json{{"cell", job.cell},
                {"seed", job.seed},
                {"scenario", job.scenario},
                {"level", job.level},
                {"perception", job.perception},
                {"set", job.set}}
               .dump()
        << "\n";
  out.close();
  if (!out) throw ConfigError(jobs_file(dir) + ": cannot be written; is the disk full?");
}

std::vector<std::string> drive_arguments(const std::string& dir, const Job& job) {
  std::vector<std::string> words = {"run", dir + "/" + job.scenario, "--seed", std::to_string(job.seed)};
  if (!job.level.empty()) words.insert(words.end(), {"--level", job.level});
  if (!job.perception.empty()) words.insert(words.end(), {"--perception", job.perception});
  for (const std::string& setting : job.set) words.insert(words.end(), {"--set", setting});
  return words;
}

std::string repeat_command(const std::string& dir, const Job& job) {
  std::string command = "./rover";
  for (const std::string& word : drive_arguments(dir, job)) command += " " + shell_word(word);
  return command + " --record full";
}

}  // namespace rover::campaign
