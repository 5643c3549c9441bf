#include "kinematics.h"

#include "five_bar.h"
#include "rotary_delta.h"
#include "vectors.h"

#include <float.h>
#include <math.h>

/* Of ρ² - K², relative to the sum of the squares that make K. */
static const float EDGE_ROUNDING = 4.0f * FLT_EPSILON;
/* Of a tip beside the plane of a five-bar, mm: what rounding may add. */
static const float BESIDE_MOST = 0.01f;

/* A joint angle by its cosine and sine. */
struct turn {
    float cosine, sine;
};

/* Moved inward by the effector's radius. */
static struct dv_vector elbow_at(const struct dv_limb *limb, struct turn turn)
{
    float out = limb->offset + limb->upper_arm * turn.cosine;
    return (struct dv_vector){
        out * limb->cos_azimuth,
        out * limb->sin_azimuth,
        -limb->upper_arm * turn.sine,
    };
}

/* How much a forearm lengthens, per rad, if the joint turned and the effector did not: -S·∂D/∂θ;
 * negative with the elbow outside.
 */
static float lengthening(const struct dv_limb *limb, struct turn turn, struct dv_vector forearm)
{
    float outward = forearm.x * limb->cos_azimuth + forearm.y * limb->sin_azimuth;
    return limb->upper_arm * (outward * turn.sine + forearm.z * turn.cosine);
}

static bool meet(const struct dv_parameters *parameters, const struct dv_vector *elbows,
                 struct dv_vector *centre)
{
    return parameters->configure.kind == DV_KIND_FIVE_BAR
        ? dv_five_bar_meet(parameters, elbows, centre)
        : dv_rotary_delta_meet(parameters, elbows, centre);
}

static bool works(const struct dv_parameters *parameters, const struct dv_vector *forearms)
{
    return parameters->configure.kind == DV_KIND_FIVE_BAR
        ? dv_five_bar_works(forearms)
        : dv_rotary_delta_works(parameters, forearms);
}

bool dv_forward(const struct dv_parameters *parameters, const float *theta, float tip[3])
{
    struct turn turns[DV_ARMS_MAX];
    struct dv_vector elbows[DV_ARMS_MAX], centre;
    for (int i = 0; i < parameters->arms; i++) {
        turns[i] = (struct turn){cosf(theta[i]), sinf(theta[i])};
        elbows[i] = elbow_at(&parameters->limb[i], turns[i]);
    }
    if (parameters->arms == 0 || !meet(parameters, elbows, &centre)) {
        return false;
    }
    for (int i = 0; i < parameters->arms; i++) {
        if (!(lengthening(&parameters->limb[i], turns[i], dv_minus(centre, elbows[i])) < 0.0f)) {
            return false;
        }
    }
    const float *tool = parameters->configure.tool_offset;
    tip[0] = centre.x + tool[0];
    tip[1] = centre.y + tool[1];
    tip[2] = centre.z + tool[2];
    return true;
}

/* The effector's centre. False where none of this kind can be. */
static bool centre_of(const struct dv_parameters *parameters, const float tip[3],
                      struct dv_vector *centre)
{
    const float *tool = parameters->configure.tool_offset;
    *centre = (struct dv_vector){tip[0] - tool[0], tip[1] - tool[1], tip[2] - tool[2]};
    if (parameters->configure.kind == DV_KIND_FIVE_BAR) {
        bool in_plane = fabsf(centre->y) <= BESIDE_MOST;
        centre->y = 0.0f;
        return in_plane;
    }
    return parameters->arms > 0;
}

/* In the arm's own plane, p outward from the motor axis and z up, the elbow runs on a circle of
 * radius L; the effector's centre is v beside that plane:
 * K = (p² + v² + z² + L² - l²) / 2L, ρ² = p² + z², q = √(ρ² - K²),
 * ρ² sin θ = -z K - p q, ρ² cos θ = p K - z q. `scaled` is ρ² of these.
 */
static bool scaled_turn(const struct dv_limb *limb, struct dv_vector centre, struct turn *scaled,
                        float *scale)
{
    float p = centre.x * limb->cos_azimuth + centre.y * limb->sin_azimuth - limb->offset;
    float v = centre.y * limb->cos_azimuth - centre.x * limb->sin_azimuth;
    float z = centre.z, upper = limb->upper_arm, fore = limb->forearm;
    float in_plane = p * p + z * z;
    float point = in_plane + v * v;
    float k = (point + dv_square_less(upper, fore)) / (2.0f * upper);
    float edge = EDGE_ROUNDING * fabsf(k) * (point + upper * upper + fore * fore) / upper;
    float square = in_plane - k * k;
    if (!(square >= -edge)) {
        return false;
    }
    float q = square > 0.0f ? sqrtf(square) : 0.0f;
    *scaled = (struct turn){p * k - z * q, -z * k - p * q};
    *scale = in_plane;
    return true;
}

bool dv_inverse(const struct dv_parameters *parameters, const float tip[3], float *theta)
{
    struct dv_vector centre;
    bool reached = centre_of(parameters, tip, &centre);
    for (int i = 0; i < parameters->arms; i++) {
        struct turn scaled = {1.0f, 0.0f};
        float scale;
        reached = scaled_turn(&parameters->limb[i], centre, &scaled, &scale) && reached;
        theta[i] = atan2f(scaled.sine, scaled.cosine);
    }
    return reached;
}

/* With the elbow's centre D, S = P - D and D' = ∂D/∂θ, the constraint S² = l² gives θ̇ = S·Ṗ / S·D'
 * and θ̈ = ((Ṗ - D' θ̇)² + S·P̈ - S·D'' θ̇²) / S·D'. False at the very edge of reach.
 */
static bool motion_of(const struct dv_limb *limb, struct turn turn, struct dv_vector forearm,
                      struct dv_vector velocity, struct dv_vector acceleration,
                      struct dv_joint_motion *motion)
{
    float lever = -lengthening(limb, turn, forearm);
    if (!(lever > 0.0f)) {
        return false;
    }
    float outward = forearm.x * limb->cos_azimuth + forearm.y * limb->sin_azimuth;
    float upper = limb->upper_arm, rate = dv_dot(forearm, velocity) / lever;
    float along = upper * turn.sine * rate;
    struct dv_vector swing = {
        velocity.x + along * limb->cos_azimuth,
        velocity.y + along * limb->sin_azimuth,
        velocity.z + upper * turn.cosine * rate,
    };
    float bend = upper * (forearm.z * turn.sine - outward * turn.cosine);
    float pull = dv_dot(swing, swing) + dv_dot(forearm, acceleration) - bend * rate * rate;
    motion->angle = atan2f(turn.sine, turn.cosine);
    motion->rate = rate;
    motion->acceleration = pull / lever;
    motion->gain = limb->forearm / lever;
    return true;
}

bool dv_joint_motions(const struct dv_parameters *parameters, const float tip[3],
                      const float velocity[3], const float acceleration[3],
                      struct dv_joint_motion *motions)
{
    struct dv_vector centre, forearms[DV_ARMS_MAX];
    struct dv_vector v = {velocity[0], velocity[1], velocity[2]};
    struct dv_vector a = {acceleration[0], acceleration[1], acceleration[2]};
    if (!centre_of(parameters, tip, &centre)) {
        return false;
    }
    for (int i = 0; i < parameters->arms; i++) {
        const struct dv_limb *limb = &parameters->limb[i];
        struct turn turn;
        float scale;
        if (!scaled_turn(limb, centre, &turn, &scale)) {
            return false;
        }
        turn = (struct turn){turn.cosine / scale, turn.sine / scale};
        forearms[i] = dv_minus(centre, elbow_at(limb, turn));
        if (!motion_of(limb, turn, forearms[i], v, a, &motions[i])) {
            return false;
        }
    }
    return works(parameters, forearms);
}
