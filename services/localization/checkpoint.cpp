#include "localization/checkpoint.hpp"

#include <cmath>
#include <cstring>

namespace rover::loc {
namespace {

constexpr double kVersion = 6.0;
constexpr size_t kPoseSize = 7;

class Writer {
 public:
  void put(double value) { values_.push_back(value); }
  template <class Matrix>
  void put_all(const Matrix& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) put(m.data()[i]);
  }
  void put_pose(const Eigen::Isometry3d& T) {
    const Eigen::Quaterniond q(T.linear());
    put_all(Eigen::Vector3d(T.translation()));
    put_all(q.coeffs());
  }
  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> out(values_.size() * sizeof(double));
    std::memcpy(out.data(), values_.data(), out.size());
    return out;
  }

 private:
  std::vector<double> values_;
};

class Reader {
 public:
  explicit Reader(const std::vector<std::uint8_t>& bytes) : values_(bytes.size() / sizeof(double)) {
    std::memcpy(values_.data(), bytes.data(), values_.size() * sizeof(double));
  }
  double get() { return values_[next_++]; }
  template <class Matrix>
  void get_all(Matrix& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = get();
  }
  Eigen::Isometry3d get_pose() {
    Eigen::Vector3d p;
    Eigen::Quaterniond q;
    get_all(p);
    get_all(q.coeffs());
    return make_pose(q.normalized().toRotationMatrix(), p);
  }

 private:
  std::vector<double> values_;
  size_t next_ = 0;
};

constexpr size_t kCount = 1 + 1 + 2 * kPoseSize + 1 + 3 + kErrorSize * kErrorSize + 1 + 1 + 1 + 6 + 3 + 6 + 4;

bool is_valid(const Checkpoint& c) {
  return is_finite(c.T_odom_body) && is_finite(c.T_map_odom) && c.gyro_bias_radps.allFinite() && c.P.allFinite() &&
         c.newest_visual_utime <= c.utime && (c.P.diagonal().array() >= 0.0).all() && std::isfinite(c.travelled_m) &&
         c.gravity_mps2 > 0.0 && std::isfinite(c.traction) && std::isfinite(c.mean_traction) &&
         std::isfinite(c.side_slip) && c.smoothing_offset_m.allFinite() && c.smoothing_offset_rad.allFinite() &&
         c.imu_healthy_utime <= c.utime && c.consecutive_conflicts >= 0 && std::isfinite(c.conflict_span_s) &&
         std::isfinite(c.dead_reckoned_m);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const Checkpoint& c) {
  Writer w;
  w.put(kVersion);
  w.put(static_cast<double>(c.utime));
  w.put_pose(c.T_odom_body);
  w.put_pose(c.T_map_odom);
  w.put(c.map_known ? 1.0 : 0.0);
  w.put_all(c.gyro_bias_radps);
  w.put_all(c.P);
  w.put(c.gravity_mps2);
  w.put(c.travelled_m);
  w.put(static_cast<double>(c.newest_visual_utime));
  for (double angle : c.drive_angle_rad) w.put(angle);
  w.put(c.traction);
  w.put(c.mean_traction);
  w.put(c.side_slip);
  w.put_all(c.smoothing_offset_m);
  w.put_all(c.smoothing_offset_rad);
  w.put(c.consecutive_conflicts);
  w.put(c.conflict_span_s);
  w.put(static_cast<double>(c.imu_healthy_utime));
  w.put(c.dead_reckoned_m);
  return w.bytes();
}

std::optional<Checkpoint> from_bytes(const std::vector<std::uint8_t>& bytes) {
  if (bytes.size() != kCount * sizeof(double)) return std::nullopt;
  Reader r(bytes);
  if (r.get() != kVersion) return std::nullopt;
  Checkpoint c;
  c.utime = static_cast<Utime>(r.get());
  c.T_odom_body = r.get_pose();
  c.T_map_odom = r.get_pose();
  c.map_known = r.get() != 0.0;
  r.get_all(c.gyro_bias_radps);
  r.get_all(c.P);
  c.gravity_mps2 = r.get();
  c.travelled_m = r.get();
  c.newest_visual_utime = static_cast<Utime>(r.get());
  for (double& angle : c.drive_angle_rad) angle = r.get();
  c.traction = r.get();
  c.mean_traction = r.get();
  c.side_slip = r.get();
  r.get_all(c.smoothing_offset_m);
  r.get_all(c.smoothing_offset_rad);
  c.consecutive_conflicts = static_cast<int>(r.get());
  c.conflict_span_s = r.get();
  c.imu_healthy_utime = static_cast<Utime>(r.get());
  c.dead_reckoned_m = r.get();
  if (!is_valid(c)) return std::nullopt;
  return c;
}

}  // namespace rover::loc
