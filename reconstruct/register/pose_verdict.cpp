// SPDX-License-Identifier: GPL-3.0-or-later
#include <facula/reconstruct/register/pose_verdict.hpp>

#include <algorithm>
#include <cmath>
#include <locale>
#include <sstream>

namespace facula {
namespace {

constexpr double kMaxContradiction = 0.1;
constexpr double kMaxMisfit = 0.5;
constexpr double kMaxDoubt = 0.6;     // misfit plus twice the contradiction [1]
constexpr double kRivalShare = 0.8;   // of the best pose's quality, to be a rival [1]
constexpr double kRivalDoubt = 0.05;  // above the best pose's doubt, at most [1]

/// "44.1 %".
std::string percent(double share) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::round(1000 * share) / 10 << " %";
  return text.str();
}

std::string millimetres(double length) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(3);
  text << 1000 * length << " mm";
  return text.str();
}

/// What speaks against a pose; a point in free space more than one off a surface.
double doubt(const PoseScore& score) {
  return score.misfit + 2 * score.contradiction;
}

/// Whether a pose explains the scans about as well as the best: by as many points, and with hardly
/// more that speaks against it (the furniture of a room that is the same after half a turn).
bool is_rival(const PoseScore& score, const PoseScore& best) {
  return quality(score) >= kRivalShare * quality(best) && doubt(score) <= doubt(best) + kRivalDoubt;
}

std::string figures_of(const PoseScore& score) {
  return percent(score.overlap) + " of the smaller scan lies on the other, " +
         percent(score.misfit) + " of the points near it do not, and " +
         percent(score.contradiction) + " stand where the other scan looked through";
}

std::string refusal(const std::vector<JudgedPose>& poses, const GlobalOptions& options) {
  if (poses.empty()) return "no pose brings parts of the two scans together";
  return "no pose explains both scans: at the best one " + figures_of(poses.front().score) +
         " (needed: at least " + percent(options.min_overlap) + ", at most " + percent(kMaxMisfit) +
         " and " + percent(kMaxContradiction) + ")";
}

}  // namespace

const char* to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccepted:
      return "accepted";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kRefused:
      return "refused";
  }
  return "refused";
}

double quality(const PoseScore& score) {
  return score.overlap * (1 - score.misfit) * (1 - score.contradiction);
}

bool fits(const PoseScore& score, double min_overlap) {
  return score.overlap >= min_overlap && score.contradiction <= kMaxContradiction &&
         score.misfit <= kMaxMisfit && doubt(score) <= kMaxDoubt;
}

GlobalResult verdict_on(const std::vector<JudgedPose>& refined,
                        const std::vector<JudgedPose>& rough,
                        const GlobalOptions& options) {
  GlobalResult result;
  std::vector<JudgedPose> fitting;
  for (const JudgedPose& pose : refined) {
    if (fits(pose.score, options.min_overlap)) fitting.push_back(pose);
  }
  if (fitting.empty()) {
    const auto& shown = refined.empty() ? rough : refined;
    if (!shown.empty()) {
      result.pair = shown.front().pair;
      result.score = shown.front().score;
    }
    result.reason = refusal(shown, options);
    return result;
  }
  const JudgedPose& best = fitting.front();
  result.pair = best.pair;
  result.score = best.score;
  double next_overlap = 0;
  for (std::size_t i = 1; i < fitting.size(); ++i) {
    if (is_rival(fitting[i].score, best.score)) {
      if (result.rivals.empty()) next_overlap = fitting[i].score.overlap;
      result.rivals.push_back(fitting[i].pair);
    }
  }
  if (!result.rivals.empty()) {
    result.verdict = Verdict::kAmbiguous;
    result.reason = std::to_string(result.rivals.size() + 1) +
                    " poses explain the scans about equally well: at the best " +
                    percent(best.score.overlap) +
                    " of the smaller scan lies on the other, at the next " + percent(next_overlap);
  } else if (!best.pair.undecided.empty()) {
    result.verdict = Verdict::kAmbiguous;
    result.reason = "where the scans overlap one " + best.pair.undecided.front().motion +
                    " against the other without a trace: the pose is not decided";
  } else {
    result.verdict = Verdict::kAccepted;
    result.reason = figures_of(best.score) + "; rms " + millimetres(best.score.inlier_rms) +
                    ", and no other pose comes near";
  }
  return result;
}

}  // namespace facula
