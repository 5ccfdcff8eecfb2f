#pragma once
#include "evert/forces/kernels/measure_kernels.hpp"
#include "evert/forces/kernels/point_run.hpp"
#include "evert/materials/plasticity.hpp"
#include "evert/math/lower_triangle.hpp"

#include <type_traits>

/// Plastic flow.  paper A, section 6.3; PHYSICS 6
///
/// What a flowing point changes is its shape data, and nothing else: with F_e = F F_p⁻¹ = Σ x_a ⊗ F_p⁻ᵀ
/// ∂N_a/∂X all kernels compute F_e where they would compute F, and the forces Σ P_e F_p⁻ᵀ ∂N_a/∂X where they
/// would compute those of P. A block without flow pays nothing, one that does not flow at present a
/// comparison.
///
/// Of F_p = Q L only the lower triangle L is kept. The rotation Q between is of no consequence to isotropic
/// materials, and shape data that are triangular stay so.
namespace evert::kernels {

/// Numbers kept per point and lane: L row after row, α, the work that has gone into flow, and that of the
/// control on the elastic energy [J/m³].
inline constexpr std::size_t plastic_numbers = 9;
/// log S of the goal, the lower triangle row after row.
inline constexpr std::size_t goal_numbers = 6;

/// Models of which points may flow; plastic strain is kept in double.
template <class T, class Model>
concept MayFlow = std::is_same_v < scalar_t<T>,
double > &&!HasFibres<Model> && !NeedsFrames<Model>;

/// The state of one point.
template <Real T>
struct PlasticPoint {
  double* numbers;

  template <const auto& element>
  EVERT_ALWAYS_INLINE static PlasticPoint at(const PlasticArrays& plastic, const PointPlace& place) {
    const std::size_t point = static_cast<std::size_t>(place.batch) * element.points + place.q;
    return {plastic.state + point * plastic_numbers * lanes_v<T>};
  }
  [[nodiscard]] EVERT_ALWAYS_INLINE T number(std::size_t i) const {
    return load<T>(numbers + i * lanes_v<T>);
  }
  EVERT_ALWAYS_INLINE void set(std::size_t i, const T& value) const {
    store(value, numbers + i * lanes_v<T>);
  }

  [[nodiscard]] EVERT_ALWAYS_INLINE LowerTriangle<T> deformation() const {
    return {number(0), number(1), number(2), number(3), number(4), number(5)};
  }
  EVERT_ALWAYS_INLINE void set_deformation(const LowerTriangle<T>& l) const {
    const std::array<T, 6> entries{l.l00, l.l10, l.l11, l.l20, l.l21, l.l22};
    for (std::size_t i = 0; i < entries.size(); ++i) set(i, entries[i]);
  }
  [[nodiscard]] EVERT_ALWAYS_INLINE T alpha() const { return number(6); }
  EVERT_ALWAYS_INLINE void set_alpha(const T& alpha) const { set(6, alpha); }
  [[nodiscard]] EVERT_ALWAYS_INLINE T work() const { return number(7); }
  EVERT_ALWAYS_INLINE void set_work(const T& work) const { set(7, work); }
  [[nodiscard]] EVERT_ALWAYS_INLINE T control_work() const { return number(8); }
  EVERT_ALWAYS_INLINE void set_control_work(const T& work) const { set(8, work); }
};

/// What a run of flowing points holds besides PointRun.
template <Real T>
struct FlowRun {
  template <class Value>
  using PerPoint = typename PointRun<T>::template PerPoint<Value>;

  PerPoint<Vec3<T>> log_growth;
  PerPoint<T> amount;                        ///< Δα; 0 where nothing flows
  PerPoint<Mat3<T>> trial_strain;            ///< log V of the trial state, unless a control attracts
  PerPoint<T> trial_energy;                  ///< ψ of it, where one does
  PerPoint<LowerTriangle<T>> before, after;  ///< F_p
};

/// False where nothing can yield: |log σ| ≤ γ/√3 for all three is implied by 1/(1 + γ/√3) ≤ σ ≤ 1 + γ/√3.
template <Real T, const auto& element>
EVERT_STAGE bool may_yield(const PlasticArrays& plastic, BatchRange batches, const PointRun<T>& run,
                           std::size_t points) {
  const bool hardens = plastic.law.hardening > 0;
  bool may = false;
  for (std::size_t i = 0; i < points; ++i) {
    const auto point = PlasticPoint<T>::template at<element>(plastic, place_of<element>(batches, i));
    T bound = T(1 + 0.577 * plastic.law.yield);
    if (hardens) bound += T(0.577 * plastic.law.hardening) * point.alpha();
    const Vec3<T> sigma = principal_stretches(run.plane[i]);
    const T largest = max(max(sigma[0], sigma[1]), sigma[2]);
    const T smallest = min(min(sigma[0], sigma[1]), sigma[2]);
    may = may || any(smallest > T(flattest_flow) && (largest > bound || smallest * bound < T(1.0)));
  }
  return may;
}

/// What flows at each point; false where nothing does.
template <Real T, const auto& element>
EVERT_STAGE bool yield_stage(const PlasticArrays& plastic, BatchRange batches, const PointRun<T>& run,
                             std::size_t points, FlowRun<T>& flowing) {
  bool flows = false;
  for (std::size_t i = 0; i < points; ++i) {
    const auto point = PlasticPoint<T>::template at<element>(plastic, place_of<element>(batches, i));
    const auto flow = plastic_flow(plastic.law, principal_stretches(run.plane[i]), point.alpha(), plastic.dt);
    flowing.log_growth[i] = flow.log_growth;
    flowing.amount[i] = flow.amount;
    flows = flows || any(flow.amount > T(0.0));
  }
  return flows;
}

template <Real T>
EVERT_ALWAYS_INLINE LowerTriangle<T> select_triangle(const mask_t<T>& mask, const LowerTriangle<T>& a,
                                                     const LowerTriangle<T>& b) {
  return {select(mask, a.l00, b.l00), select(mask, a.l10, b.l10), select(mask, a.l11, b.l11),
          select(mask, a.l20, b.l20), select(mask, a.l21, b.l21), select(mask, a.l22, b.l22)};
}

/// Brings principal stretches outside [1/limit, limit] back along the ray to no plastic strain; a deviator
/// stays one.
template <Real T>
EVERT_STAGE void limit_stretches(double limit, LowerTriangle<T>& deformation) {
  const Deflation<T> parts = deflate(matrix(deformation));
  const Vec3<T> stretch = principal_stretches(parts);
  const Vec3<T> strain{log(stretch[0]), log(stretch[1]), log(stretch[2])};
  const T largest = max(max(abs(strain[0]), abs(strain[1])), abs(strain[2]));
  const T allowed = T(std::log(limit));
  const T share = allowed / max(largest, allowed);
  const Vec3<T> limited{exp(share * strain[0]), exp(share * strain[1]), exp(share * strain[2])};
  deformation =
      select_triangle(largest > allowed, lower_factor(isotropic_tensor(parts, limited)), deformation);
}

/// F_p after the flow: Q L of diag(growth) Vᵀ F_p.
template <Real T, const auto& element>
EVERT_STAGE void plastic_deformation_stage(const PlasticArrays& plastic, BatchRange batches,
                                           const PointRun<T>& run, std::size_t points, FlowRun<T>& flowing) {
  const T one(1.0);
  const T limit_square(plastic.law.limit * plastic.law.limit);
  for (std::size_t i = 0; i < points; ++i) {
    const auto point = PlasticPoint<T>::template at<element>(plastic, place_of<element>(batches, i));
    const LowerTriangle<T> before = point.deformation();
    flowing.before[i] = before;
    const Vec3<T>& strain = flowing.log_growth[i];
    const Vec3<T> growth{exp(strain[0]), exp(strain[1]), exp(strain[2])};
    LowerTriangle<T> after =
        lower_factor(isotropic_tensor(run.left[i], run.plane[i], run.right[i], growth) * before);
    // Rounding would add up.
    if (plastic.law.isochoric) after = (one - T(1.0 / 3) * (determinant(after) - one)) * after;
    if (any(square_norm(after) > limit_square || square_norm(inverse(after)) > limit_square))
      limit_stretches(plastic.law.limit, after);
    flowing.after[i] = select_triangle(flowing.amount[i] > T(0.0), after, before);
  }
}

/// U diag(p) Uᵀ of a point of a diagonalised run, with p in the order of principal_stretches().
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> spatial_tensor(const PointRun<T>& run, std::size_t i, const Vec3<T>& p) {
  return times_transpose(isotropic_tensor(run.left[i], run.plane[i], run.right[i], p),
                         polar_rotation(run.left[i], run.plane[i], run.right[i]));
}

/// log V of F_e = V R; flat and inverted stretches count as the flattest that flow.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> spatial_log_strain(const PointRun<T>& run, std::size_t i) {
  const T floor = T(flattest_flow);
  const Vec3<T> sigma = principal_stretches(run.plane[i]);
  return spatial_tensor(run, i,
                        {log(max(sigma[0], floor)), log(max(sigma[1], floor)), log(max(sigma[2], floor))});
}

template <Real T>
EVERT_STAGE void trial_strain_stage(const PointRun<T>& run, std::size_t points, FlowRun<T>& flowing) {
  for (std::size_t i = 0; i < points; ++i) flowing.trial_strain[i] = spatial_log_strain(run, i);
}

template <Real T, class Model>
EVERT_STAGE void trial_energy_stage(const Model& model, const PointRun<T>& run, std::size_t points,
                                    FlowRun<T>& flowing) {
  for (std::size_t i = 0; i < points; ++i)
    flowing.trial_energy[i] = model.energy(principal_stretches(run.plane[i]));
}

/// log S of F_p = R S.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> log_stretch(const LowerTriangle<T>& deformation) {
  const Deflation<T> parts = deflate(matrix(deformation));
  const Vec3<T> stretch = principal_stretches(parts);
  const Vec3<T> strain{log(stretch[0]), log(stretch[1]), log(stretch[2])};
  return transpose_times(polar_rotation(parts), isotropic_tensor(parts, strain));
}

/// e^C of a symmetric matrix; its principal values, raised above 0, are singular values.
template <Real T>
EVERT_ALWAYS_INLINE Mat3<T> exponential(const Mat3<T>& c) {
  const T raise = T(1.0) + sqrt(contract(c, c));
  const Deflation<T> parts = deflate(c + raise * identity<T>());
  const Vec3<T> raised = principal_stretches(parts);
  return isotropic_tensor(parts, {exp(raised[0] - raise), exp(raised[1] - raise), exp(raised[2] - raise)});
}

template <Real T, const auto& element>
EVERT_ALWAYS_INLINE Mat3<T> load_goal(const PlasticArrays& plastic, const PointPlace& place) {
  const std::size_t point = static_cast<std::size_t>(place.batch) * element.points + place.q;
  const double* numbers = plastic.goal + point * goal_numbers * lanes_v<T>;
  const auto at = [&](std::size_t i) { return load<T>(numbers + i * lanes_v<T>); };
  const T c10 = at(1), c20 = at(3), c21 = at(4);
  return {{{{at(0), c10, c20}, {c10, at(2), c21}, {c20, c21, at(5)}}}};
}

/// Turns the flow towards the goal: log S ends in the point of the segment between before and after that is
/// nearest to the goal, and goes a part of the rest of the way there by itself.  paper A, section 7
template <Real T, const auto& element>
EVERT_STAGE void control_stage(const PlasticArrays& plastic, BatchRange batches, std::size_t points,
                               FlowRun<T>& flowing) {
  constexpr double rounding = 1e-14;
  for (std::size_t i = 0; i < points; ++i) {
    const Mat3<T> goal = load_goal<T, element>(plastic, place_of<element>(batches, i));
    const Mat3<T> before = log_stretch(flowing.before[i]);
    const Mat3<T> way = log_stretch(flowing.after[i]) - before;
    const T square = contract(way, way);
    const T share = min(max(contract(goal - before, way) / max(square, T(1e-30)), T(0.0)), T(1.0));
    const Mat3<T> nearest = before + share * way;
    const Mat3<T> end = nearest + T(plastic.attraction) * (goal - nearest);
    const Mat3<T> gone = end - before;
    const T amount = sqrt(contract(gone, gone));
    const auto flows = amount > T(rounding);
    flowing.amount[i] = select(flows, amount, T(0.0));
    flowing.after[i] = select_triangle(flows, lower_factor(exponential(end)), flowing.before[i]);
  }
}

/// L⁻ᵀ v, with `l` = L⁻¹: shape data at rest as those of F_p⁻¹. Triangular ones stay so.
template <Real T>
EVERT_ALWAYS_INLINE Vec3<T> times_inverse(const Vec3<T>& v, const LowerTriangle<T>& l) {
  return {v[0] * l.l00 + (v[1] * l.l10 + v[2] * l.l20), v[1] * l.l11 + v[2] * l.l21, v[2] * l.l22};
}

/// Turns the shape data at rest into those of the present F_p⁻¹.
template <Real T, const auto& element>
EVERT_STAGE void deform_shapes(const PlasticArrays& plastic, BatchRange batches) {
  using Shape = RestGradients<T, element>;
  constexpr std::size_t numbers_a_point = Shape::layout.numbers() * lanes_v<T>;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    const std::size_t first = static_cast<std::size_t>(b) * element.points * numbers_a_point;
    const Shape rest{{plastic.rest_shapes + first}};
    for (std::size_t q = 0; q < element.points; ++q) {
      const auto point = PlasticPoint<T>::template at<element>(plastic, {b, q});
      const LowerTriangle<T> l = inverse(point.deformation());
      double* const shape = plastic.shapes + first + q * numbers_a_point;
      for (std::size_t j = 0; j < Shape::layout.vectors; ++j) {
        const Vec3<T> flown = times_inverse(rest.vector(q, j), l);
        for (std::size_t k = 0; k < Shape::layout.components(j); ++k)
          store(flown[k], shape + (Shape::layout.begin(j) + k) * lanes_v<T>);
      }
    }
  }
}

template <Real T, const auto& element>
EVERT_STAGE void keep_deformation(const PlasticArrays& plastic, BatchRange batches, std::size_t points,
                                  const FlowRun<T>& flowing) {
  for (std::size_t i = 0; i < points; ++i)
    PlasticPoint<T>::template at<element>(plastic, place_of<element>(batches, i))
        .set_deformation(flowing.after[i]);
}

/// Flow takes energy or does not happen: τ : Δ log V, with the Kirchhoff stress τ that is left, is the work
/// on it. (What ψ has lost is more, by what the trial went too far.) The return along a ray takes energy, of
/// models whose stress grows with strain (Baker, Ericksen: st_venant_kirchhoff far compressed is not one);
/// the limit of F_p may turn it aside. Takes what would cost energy back from `flowing`; true where there is
/// some. A control that attracts may cost energy: while it does, all that flow changes of ψ is its work.
template <Real T, const auto& element, class Model>
EVERT_STAGE bool plastic_work_stage(const Model& model, const PlasticArrays& plastic, BatchRange batches,
                                    const PointRun<T>& run, FlowRun<T>& flowing) {
  bool taken_back = false;
  std::size_t i = 0;
  for (LocalIndex b = batches.begin; b < batches.end; ++b) {
    T most = T(0.0);
    for (std::size_t q = 0; q < element.points; ++q, ++i) {
      const auto point = PlasticPoint<T>::template at<element>(plastic, {b, q});
      const Vec3<T> sigma = principal_stretches(run.plane[i]);
      if (plastic.attraction > 0) {
        const T change = model.energy(sigma) - flowing.trial_energy[i];
        point.set_control_work(point.control_work() + select(flowing.amount[i] > T(0.0), change, T(0.0)));
        point.set_alpha(point.alpha() + flowing.amount[i]);
        most = max(most, flowing.amount[i]);
        continue;
      }
      const Vec3<T> stress = model.principal_stress(sigma);
      const Vec3<T> kirchhoff{sigma[0] * stress[0], sigma[1] * stress[1], sigma[2] * stress[2]};
      const T work =
          contract(spatial_tensor(run, i, kirchhoff), flowing.trial_strain[i] - spatial_log_strain(run, i));
      const auto flows = flowing.amount[i] > T(0.0) && work >= T(0.0);
      taken_back = taken_back || any(flowing.amount[i] > T(0.0) && !flows);
      const T amount = select(flows, flowing.amount[i], T(0.0));
      flowing.after[i] = select_triangle(flows, flowing.after[i], flowing.before[i]);
      point.set_work(point.work() + select(flows, work, T(0.0)));
      point.set_alpha(point.alpha() + amount);
      most = max(most, amount);
    }
    for (std::size_t l = 0; l < lanes_v<T>; ++l)
      plastic.drift[static_cast<std::size_t>(b) * lanes_v<T> + l] += static_cast<float>(lane(most, l));
  }
  return taken_back;
}

/// Lets what yields flow, and leaves the run at the F_e that remain, diagonalised: bit by bit what it would
/// be of the same F_p without flow, so that a restart goes on as if there had been none.
template <Real T, const auto& element, class Model>
EVERT_ALWAYS_INLINE void flow(const Model& model, const BlockArrays& block, const double* x,
                              BatchRange batches, PointRun<T>& run, std::size_t points) {
  const PlasticArrays& plastic = *block.plastic;
  if (!(plastic.dt > 0)) return;  // the same state looked at again: after a restart, or an event
  const bool attracts = plastic.attraction > 0;
  if (!attracts && !may_yield<T, element>(plastic, batches, run, points)) return;
  FlowRun<T> flowing;
  if (!yield_stage<T, element>(plastic, batches, run, points, flowing) && !attracts) return;
  if (attracts)
    trial_energy_stage(model, run, points, flowing);
  else
    trial_strain_stage(run, points, flowing);
  plastic_deformation_stage<T, element>(plastic, batches, run, points, flowing);
  if (plastic.goal != nullptr) control_stage<T, element>(plastic, batches, points, flowing);
  const auto deform = [&] {
    keep_deformation<T, element>(plastic, batches, points, flowing);
    deform_shapes<T, element>(plastic, batches);
    gather_field_gradients<T, element>(block, x, batches, run.deformation_gradient.data());
    diagonalize(run, points);
  };
  deform();
  if (plastic_work_stage<T, element>(model, plastic, batches, run, flowing)) deform();
}

}  // namespace evert::kernels
