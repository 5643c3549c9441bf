/* Vectors of space, in mm. */
#ifndef DV_VECTORS_H
#define DV_VECTORS_H

struct dv_vector {
    float x, y, z;
};

static inline struct dv_vector dv_minus(struct dv_vector a, struct dv_vector b)
{
    return (struct dv_vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct dv_vector dv_cross(struct dv_vector a, struct dv_vector b)
{
    return (struct dv_vector){
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    };
}

static inline float dv_dot(struct dv_vector a, struct dv_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* s a + t b */
static inline struct dv_vector dv_combined(float s, struct dv_vector a, float t, struct dv_vector b)
{
    return (struct dv_vector){s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

/* The difference of two squares, without the loss of two large numbers' difference. */
static inline float dv_square_less(float a, float b)
{
    return (a - b) * (a + b);
}

#endif
