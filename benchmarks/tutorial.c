/* Delta kinematics the way the well-known tutorial has it: one pose a call, the arm's plane turned
 * to x = 0, a quadratic for the elbow (inverse), three spheres eliminated (forward). Sides f and e,
 * arms at -90, 30 and 150 degrees, angles in degrees. Written from the formulas, to compare with.
 */
#include <math.h>
#include <stddef.h>

static const double PI = 3.141592653589793;
static const double SQRT3 = 1.7320508075688772;

struct sides { double f, e, upper_arm, forearm; };

static int arm_angle(const struct sides *d, double x, double y, double z, double *theta)
{
    const double motor_y = -0.5 * d->f / SQRT3;
    y -= 0.5 * d->e / SQRT3;
    /* The elbow lies on z = a + b y, and at a distance of one upper arm from the motor. */
    const double a = (x * x + y * y + z * z + d->upper_arm * d->upper_arm
                      - d->forearm * d->forearm - motor_y * motor_y) / (2.0 * z);
    const double b = (motor_y - y) / z;
    const double root = -(a + b * motor_y) * (a + b * motor_y)
                        + d->upper_arm * (b * b * d->upper_arm + d->upper_arm);
    if (root < 0.0) return -1;
    const double elbow_y = (motor_y - a * b - sqrt(root)) / (b * b + 1.0);
    const double elbow_z = a + b * elbow_y;
    *theta = 180.0 * atan(-elbow_z / (motor_y - elbow_y)) / PI + (elbow_y > motor_y ? 180.0 : 0.0);
    return 0;
}

static int inverse(const struct sides *d, double x, double y, double z, double *theta)
{
    const double cos120 = -0.5, sin120 = SQRT3 / 2.0;
    int status = arm_angle(d, x, y, z, &theta[0]);
    if (status == 0)
        status = arm_angle(d, x * cos120 + y * sin120, y * cos120 - x * sin120, z, &theta[1]);
    if (status == 0)
        status = arm_angle(d, x * cos120 - y * sin120, y * cos120 + x * sin120, z, &theta[2]);
    return status;
}

static int forward(const struct sides *d, const double *theta, double *xyz)
{
    const double t = (d->f - d->e) / (2.0 * SQRT3), rad = PI / 180.0;
    const double t1 = theta[0] * rad, t2 = theta[1] * rad, t3 = theta[2] * rad;

    const double y1 = -(t + d->upper_arm * cos(t1));
    const double z1 = -d->upper_arm * sin(t1);
    const double y2 = (t + d->upper_arm * cos(t2)) * 0.5;
    const double x2 = y2 * SQRT3;
    const double z2 = -d->upper_arm * sin(t2);
    const double y3 = (t + d->upper_arm * cos(t3)) * 0.5;
    const double x3 = -y3 * SQRT3;
    const double z3 = -d->upper_arm * sin(t3);

    /* Sphere 1 minus 2 and minus 3: x = (a1 z + b1)/den, y = (a2 z + b2)/den. */
    const double den = (y2 - y1) * x3 - (y3 - y1) * x2;
    const double w1 = y1 * y1 + z1 * z1;
    const double w2 = x2 * x2 + y2 * y2 + z2 * z2;
    const double w3 = x3 * x3 + y3 * y3 + z3 * z3;
    const double a1 = (z2 - z1) * (y3 - y1) - (z3 - z1) * (y2 - y1);
    const double b1 = -((w2 - w1) * (y3 - y1) - (w3 - w1) * (y2 - y1)) / 2.0;
    const double a2 = -(z2 - z1) * x3 + (z3 - z1) * x2;
    const double b2 = ((w2 - w1) * x3 - (w3 - w1) * x2) / 2.0;

    const double a = a1 * a1 + a2 * a2 + den * den;
    const double b = 2.0 * (a1 * b1 + a2 * (b2 - y1 * den) - z1 * den * den);
    const double c = (b2 - y1 * den) * (b2 - y1 * den) + b1 * b1
                     + den * den * (z1 * z1 - d->forearm * d->forearm);
    const double root = b * b - 4.0 * a * c;
    if (root < 0.0) return -1;
    xyz[2] = -0.5 * (b + sqrt(root)) / a;
    xyz[0] = (a1 * xyz[2] + b1) / den;
    xyz[1] = (a2 * xyz[2] + b2) / den;
    return 0;
}

int inverse_many(const double *sides, const double *xyz, double *theta, size_t count)
{
    const struct sides d = { sides[0], sides[1], sides[2], sides[3] };
    int failed = 0;
    for (size_t i = 0; i < count; i++)
        failed += inverse(&d, xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2], theta + 3 * i) != 0;
    return failed;
}

int forward_many(const double *sides, const double *theta, double *xyz, size_t count)
{
    const struct sides d = { sides[0], sides[1], sides[2], sides[3] };
    int failed = 0;
    for (size_t i = 0; i < count; i++)
        failed += forward(&d, theta + 3 * i, xyz + 3 * i) != 0;
    return failed;
}
