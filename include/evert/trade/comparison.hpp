#pragma once
#include "evert/trade/measurement.hpp"

namespace evert::trade {

/// Differences of a run from the reference.
struct Errors {
  double displacement = 0;  ///< RMS over mass and time, over the RMS of the reference's displacement [-]
  double probes = 0;        ///< RMS over probes and time, over the RMS of the reference's probes [-]
  double energy = 0;        ///< RMS of the total energy, over the largest change that the reference has [-]
  double volume = 0;        ///< RMS over the mean volume of the reference [-]
  double frequency = 0;     ///< of the dominant frequency of the probes, relative; NaN: there is none [-]
};

/// Both measured to the end of the plan. Not finite where the run went astray.
[[nodiscard]] Errors compare(const SamplePlan& plan, const Measurement& run, const Measurement& reference);
/// RMS over mass and time of the difference of two displacement fields, over the RMS of the second [-].
[[nodiscard]] double displacement_error(const SamplePlan& plan, const Measurement& run,
                                        const Measurement& reference);

/// What three refinements by one ratio say about the last of them: u2 ≈ u + e, u1 ≈ u + r e, u0 ≈ u + r² e.
/// Richardson 1911; Roache 1994
struct ReferenceQuality {
  double first = 0, second = 0;  ///< relative differences of levels 0 and 1, 1 and 2 [-]
  double reduction = 0;          ///< r = first/second: of the error at a refinement
  bool converges = false;        ///< r is that of a convergent method
  double error = 0;              ///< estimate for level 2 [-]
  double least = 0, most = 0;    ///< between which it should lie [-]
};
[[nodiscard]] ReferenceQuality assess_reference(const SamplePlan& plan, const Measurement& level0,
                                                const Measurement& level1, const Measurement& level2);
/// What the levels converge to, u2 + (u2 − u1)/(r − 1); level 2 where they do not.
[[nodiscard]] Measurement best_reference(const ReferenceQuality& quality, const Measurement& level1,
                                         const Measurement& level2);

/// Frequency [Hz] at which the values, equally spaced by `interval` [s], vary most, their trend taken away;
/// 0: they do not. Between the frequencies of the discrete transform too.
[[nodiscard]] double dominant_frequency(std::span<const double> values, double interval);

}  // namespace evert::trade
