// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/acquire/calibrate/joint_warnings.hpp>
#include <facula/acquire/rig/rig_parameters.hpp>

#include <cmath>
#include <numbers>
#include <sstream>

namespace facula {
namespace {

/// From which sigma on a parameter is called weak. A scanner of 0.1 mm at 0.3 m needs much less.
double most_sigma(const Rig& rig, const std::string& name) {
  constexpr double kTenthDegree = 0.1 * std::numbers::pi / 180;
  if (name == "camera.fx_px" || name == "camera.fy_px") return 0.005 * rig.camera.fx;
  if (name == "camera.cx_px" || name == "camera.cy_px") return 0.005 * rig.camera.width;
  if (name == "camera.k3") return 0.3;
  if (name.starts_with("camera.k")) return 0.05;
  if (name.starts_with("camera.p")) return 0.005;
  if (name.ends_with("bow_rad")) return kTenthDegree;
  if (name.ends_with("_rad")) return kTenthDegree;
  return 0.5;  // [mm]
}

}  // namespace

std::string advice_for(const std::string& parameter) {
  if (parameter.starts_with("camera.k") || parameter.starts_with("camera.p")) {
    return "show the board in the corners of the image or estimate fewer terms";
  }
  if (parameter.starts_with("camera.")) {
    return "show the board more tilted, at several distances, in every part of the image";
  }
  if (parameter.ends_with("bow_rad")) {
    return "show the line along its whole length or leave the bow out";
  }
  if (parameter.starts_with("laser.")) {
    return "show the line on boards at more distances and tilts";
  }
  if (parameter.starts_with("axis.")) {
    return "move the axis further between the pictures, with the board off the axis";
  }
  return "add views";
}

std::vector<std::string> weak_parameters(const Rig& rig) {
  std::vector<std::string> sentences;
  if (!rig.covariance) return sentences;
  for (const std::string& name : rig.covariance->parameters) {
    const double sigma = parameter_sigma(rig, name);
    if (sigma <= most_sigma(rig, name)) continue;
    std::ostringstream text;
    text.precision(3);
    text << name << " is known to +- " << sigma << " only: " << advice_for(name);
    sentences.push_back(text.str());
  }
  return sentences;
}

}  // namespace facula
