#include "kinematics.h"

#include <float.h>
#include <math.h>

/* Of ρ² - K², relative to the sum of the squares that make K. */
static const float EDGE_ROUNDING = 4.0f * FLT_EPSILON;
/* Elbow centres whose triangle is smaller than this, in squared forearms, are all rounding. */
static const float UNDETERMINED = 1e-6f;

struct vector {
    float x, y, z;
};

struct elbow {
    struct vector centre; /* moved inward by the effector's radius */
    float cosine, sine; /* of the joint angle */
};

static struct vector minus(struct vector a, struct vector b)
{
    return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct vector cross(struct vector a, struct vector b)
{
    return (struct vector){
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    };
}

static float dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* s a + t b */
static struct vector combined(float s, struct vector a, float t, struct vector b)
{
    return (struct vector){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

static struct elbow elbow_at(const struct dv_delta_arm *arm, float angle)
{
    struct elbow elbow = {.cosine = cosf(angle), .sine = sinf(angle)};
    float out = arm->offset + arm->upper_arm * elbow.cosine;
    elbow.centre = (struct vector){
        out * arm->cos_azimuth,
        out * arm->sin_azimuth,
        -arm->upper_arm * elbow.sine,
    };
    return elbow;
}

/* Squares of lengths, less those of the first, without the loss of two large numbers' difference. */
static float less(float length, float first)
{
    return (first - length) * (first + length);
}

/* Where three spheres about the elbow centres D meet, on the side of the working assembly. With
 * a = D2 - D1, b = D3 - D1, n = a × b: P = D1 + w - n √((l1² - w²) / n²),
 * w = ((|a|² + l1² - l2²) b × n + (|b|² + l1² - l3²) n × a) / 2 n².
 */
static bool meet(const struct dv_parameters *parameters, const struct elbow elbows[DV_ARMS],
                 struct vector *centre)
{
    const struct dv_delta_arm *arm = parameters->arm;
    float l1 = arm[0].forearm;
    struct vector a = minus(elbows[1].centre, elbows[0].centre);
    struct vector b = minus(elbows[2].centre, elbows[0].centre);
    struct vector n = cross(a, b);
    float square = dot(n, n);
    float least = UNDETERMINED * l1 * l1;
    if (!(square > least * least)) {
        return false;
    }
    float along_a = (dot(a, a) + less(arm[1].forearm, l1)) / (2.0f * square);
    float along_b = (dot(b, b) + less(arm[2].forearm, l1)) / (2.0f * square);
    struct vector w = combined(along_a, cross(b, n), along_b, cross(n, a));
    float height_square = l1 * l1 - dot(w, w);
    if (!(height_square >= 0.0f)) {
        return false;
    }
    float below = -parameters->handedness * sqrtf(height_square / square);
    struct vector from_first = combined(1.0f, w, below, n);
    *centre = combined(1.0f, elbows[0].centre, 1.0f, from_first);
    return true;
}

static bool elbow_is_outside(const struct dv_delta_arm *arm, const struct elbow *elbow,
                             struct vector centre)
{
    struct vector forearm = minus(centre, elbow->centre);
    float outward = forearm.x * arm->cos_azimuth + forearm.y * arm->sin_azimuth;
    return outward * elbow->sine + forearm.z * elbow->cosine < 0.0f;
}

bool dv_forward(const struct dv_parameters *parameters, const float theta[DV_ARMS], float tip[3])
{
    struct elbow elbows[DV_ARMS];
    struct vector centre;
    for (int i = 0; i < DV_ARMS; i++) {
        elbows[i] = elbow_at(&parameters->arm[i], theta[i]);
    }
    if (parameters->arms == 0 || !meet(parameters, elbows, &centre)) {
        return false;
    }
    for (int i = 0; i < DV_ARMS; i++) {
        if (!elbow_is_outside(&parameters->arm[i], &elbows[i], centre)) {
            return false;
        }
    }
    const float *tool = parameters->configure.tool_offset;
    tip[0] = centre.x + tool[0];
    tip[1] = centre.y + tool[1];
    tip[2] = centre.z + tool[2];
    return true;
}

/* In the arm's own plane, p outward from the motor axis and z up, the elbow runs on a circle of
 * radius L; the effector's centre is v beside that plane:
 * K = (p² + v² + z² + L² - l²) / 2L, ρ² = p² + z², q = √(ρ² - K²),
 * θ = atan2(-z K - p q, p K - z q).
 */
static bool arm_angle(const struct dv_delta_arm *arm, struct vector centre, float *angle)
{
    float p = centre.x * arm->cos_azimuth + centre.y * arm->sin_azimuth - arm->offset;
    float v = centre.y * arm->cos_azimuth - centre.x * arm->sin_azimuth;
    float z = centre.z, upper = arm->upper_arm, fore = arm->forearm;
    float in_plane = p * p + z * z;
    float point = in_plane + v * v;
    float k = (point + less(fore, upper)) / (2.0f * upper);
    float edge = EDGE_ROUNDING * fabsf(k) * (point + upper * upper + fore * fore) / upper;
    float square = in_plane - k * k;
    if (!(square >= -edge)) {
        return false;
    }
    float q = square > 0.0f ? sqrtf(square) : 0.0f;
    *angle = atan2f(-z * k - p * q, p * k - z * q);
    return true;
}

bool dv_inverse(const struct dv_parameters *parameters, const float tip[3], float theta[DV_ARMS])
{
    const float *tool = parameters->configure.tool_offset;
    struct vector centre = {tip[0] - tool[0], tip[1] - tool[1], tip[2] - tool[2]};
    bool reached = parameters->arms > 0;
    for (int i = 0; i < parameters->arms; i++) {
        reached = arm_angle(&parameters->arm[i], centre, &theta[i]) && reached;
    }
    return reached;
}
