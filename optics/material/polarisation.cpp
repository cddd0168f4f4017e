#include "optics/material/polarisation.h"

#include <cmath>

namespace lucerna::optics {

void Polarisation::refer_to(const Vec3& axis, const Vec3& direction) {
    if (!unpolarised_) {
        // s = cos e + sin (k x e); Q + i U turns by twice the angle.
        const double cosine = axis_.dot(axis);
        const double sine = direction.cross(axis_).dot(axis);
        const double norm = cosine * cosine + sine * sine;  // 1 but for rounding
        const auto cosine2 = static_cast<float>((cosine * cosine - sine * sine) / norm);
        const auto sine2 = static_cast<float>(2.0 * cosine * sine / norm);
        const Lanes q = cosine2 * q_ + sine2 * u_;
        u_ = cosine2 * u_ - sine2 * q_;
        q_ = q;
    }
    axis_ = axis;
}

Lanes Polarisation::flux_factor(const Mueller<double>& event) const {
    const auto mean = static_cast<float>(event.mean);
    if (unpolarised_) return Lanes::Constant(mean);
    return (mean + static_cast<float>(event.difference) * q_).max(0.0f).min(1.0f);
}

Lanes Polarisation::flux_factor(const Mueller<Lanes>& event) const {
    if (unpolarised_) return event.mean;
    return (event.mean + event.difference * q_).max(0.0f).min(1.0f);
}

void Polarisation::go_through(const Mueller<double>& event) {
    apply(static_cast<float>(event.mean), static_cast<float>(event.difference),
          static_cast<float>(event.real), static_cast<float>(event.imaginary));
}

void Polarisation::go_through(const Mueller<Lanes>& event) {
    apply(event.mean, event.difference, event.real, event.imaginary);
}

template <typename Number>
void Polarisation::apply(const Number& mean, const Number& difference, const Number& real,
                         const Number& imaginary) {
    // A lane that gets no light has any state; this one is finite.
    constexpr float least_flux = 1e-20f;
    if (unpolarised_) {
        q_ = Lanes::Ones() * difference / (Lanes::Ones() * mean).max(least_flux);
        u_ = v_ = Lanes::Zero();
        unpolarised_ = false;
        return;
    }
    const Lanes per_flux = (mean + difference * q_).max(least_flux).inverse();
    q_ = (difference + mean * q_) * per_flux;
    const Lanes u = (real * u_ - imaginary * v_) * per_flux;
    v_ = (imaginary * u_ + real * v_) * per_flux;
    u_ = u;
    // Where next to nothing is left, rounding is not small beside it.
    const Lanes squared_degree = q_.square() + u_.square() + v_.square();
    if ((squared_degree > 1.0f).any()) {
        // Not Eigen's sqrt(), whose last bit depends on the processor.
        const Lanes scale =
            squared_degree.max(1.0f).unaryExpr([](float x) { return 1.0f / std::sqrt(x); });
        q_ *= scale;
        u_ *= scale;
        v_ *= scale;
    }
}

Vec3 axis_across_incidence(const Vec3& normal, const Vec3& direction) {
    const Vec3 across = normal.cross(direction);
    const double sine = across.norm();
    return sine > 1e-10 ? Vec3(across / sine) : Frame(direction).tangent;
}

}  // namespace lucerna::optics
