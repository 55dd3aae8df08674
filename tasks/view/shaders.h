// shaders: the programs of the renderer, GLSL 3.30.
#pragma once

namespace pincer::tasks {

// Light in the shader: radiance L = albedo (sun max(n.s, 0) shadow + mix(ground, sky, (1 + n.z)/2)) + highlights; then
// an S-shaped curve so that bright places keep their colour, and sRGB's gamma.
inline constexpr const char* kSolidVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_M;
layout(location = 1) in vec3 n_M;
layout(location = 2) in vec3 edge_M;
uniform mat4 X_WM;
uniform mat3 N_WM;
uniform mat4 world_to_clip;
uniform mat4 world_to_sun;
out vec3 p_W;
out vec3 n_W;
out vec3 edge;
out vec3 p_sun;
out vec3 octant;
void main() {
  octant = p_M;
  vec4 p = X_WM * vec4(p_M, 1.0);
  p_W = p.xyz;
  n_W = N_WM * n_M;
  edge = edge_M;
  p_sun = (world_to_sun * vec4(p.xyz, 1.0)).xyz;
  gl_Position = world_to_clip * p;
}
)";

// Behind the version and three words that are 0 or 1: SOFT half shadows, GRID lines, SHEER nothing but lines and
// shadows. Programs of their own, as without a graphics card a branch that isn't taken costs as much as one that is.
inline constexpr const char* kSolidFragmentShader = R"(
in vec3 p_W;
in vec3 n_W;
in vec3 edge;
in vec3 p_sun;
in vec3 octant;
uniform vec3 eye_W;
uniform vec3 target_W;
uniform vec3 sun_W;
uniform vec4 paint;
uniform float gloss;
uniform float edges;
uniform float octants;
uniform float glow;
uniform float fade;
uniform float shadow_strength;
uniform float shadow_texel;
uniform float grid;
uniform sampler2DShadow shadow_map;
uniform sampler2D sun_depths;
out vec4 colour;

#if SOFT
const int kTaps = 32;

// Of a disc, evenly spread by the golden angle, turned by `turn` [rad].
vec2 tap(int i, float turn) {
  float angle = 2.39996323 * float(i) + turn;
  return sqrt((float(i) + 0.5) / float(kTaps)) * vec2(cos(angle), sin(angle));
}

// Another turn for each pixel, so that taps too few to be smooth show as fine grain (Jimenez 2014: interleaved gradient noise).
float grain() { return 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))); }

// Half shadows as wide as the blockers are far away (Fernando 2005, percentage-closer soft shadows); lengths in shares of the shadow map.
float softlyLit(vec3 at) {
  const float kSunWidth = 0.20, kWidest = 0.05;
  float turn = grain(), depth = 0.0, blockers = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    float seen = texture(sun_depths, at.xy + kWidest * tap(i, turn)).r;
    if (seen < at.z - 0.001) {
      depth += seen;
      blockers += 1.0;
    }
  }
  if (blockers == 0.0) return 1.0;
  float width = clamp(kSunWidth * (at.z - depth / blockers), 1.5 * shadow_texel, kWidest);
  float sum = 0.0;
  for (int i = 0; i < kTaps; ++i) sum += texture(shadow_map, vec3(at.xy + width * tap(i, turn), at.z));
  return sum / float(kTaps);
}
#endif

float lit(float slope) {
  if (shadow_strength <= 0.0) return 1.0;
  float border = max(abs(p_sun.x), abs(p_sun.y)), strength = shadow_strength * (1.0 - smoothstep(0.85, 0.98, border));
  if (border > 0.98) return 1.0;
  vec3 at = 0.5 * p_sun + 0.5;
#if SOFT
  at.z -= 0.0012 + 0.005 * slope;
  return mix(1.0, softlyLit(at), strength);
#else
  at.z -= 0.0012 + 0.0025 * slope;
  float sum = 0.0;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y) sum += texture(shadow_map, vec3(at.xy + 1.5 * shadow_texel * vec2(x, y), at.z));
  return mix(1.0, sum / 9.0, strength);
#endif
}

vec3 film(vec3 x) {  // rises like x, ends at 1
  x *= 1.0 / (1.0 + 0.18 * x * x);
  return pow(clamp(x, 0.0, 1.0), vec3(1.0 / 2.2));
}

#if GRID
// How much of a line of the grid of this spacing is in the pixel; none where lines are closer than some pixels.
float line(vec2 place, float spacing) {
  vec2 at = place / spacing, wide = max(fwidth(at), vec2(1e-6));
  vec2 near = 1.0 - clamp(abs(fract(at - 0.5) - 0.5) / wide, 0.0, 1.0);
  vec2 apart = 1.0 - smoothstep(0.08, 0.4, wide);
  return max(near.x * apart.x, near.y * apart.y);
}
float gridLine() { return max(0.28 * line(octant.xy, grid), 0.55 * line(octant.xy, 10.0 * grid)); }
#endif
float faded(float alpha) { return fade > 0.0 ? alpha * (1.0 - smoothstep(0.35 * fade, fade, length((p_W - target_W).xy))) : alpha; }
const vec3 kLine = vec3(0.10, 0.12, 0.15);

#if SHEER
void main() {
#if SOFT
  float shadow = 0.32 * (1.0 - lit(1.0 - max(normalize(n_W).z * sun_W.z, 0.0)));
#else
  float shadow = 0.0;
#endif
  colour = vec4(film(kLine), faded(max(gridLine(), shadow)));
}
#else
void main() {
  vec3 v = normalize(eye_W - p_W);
  vec3 n = normalize(n_W);
  if (!gl_FrontFacing) n = -n;
  float facing = max(dot(n, sun_W), 0.0);
  float shade = facing > 0.0 ? lit(1.0 - facing) : 0.0;
  vec3 sky = mix(vec3(0.24, 0.22, 0.21), vec3(0.40, 0.44, 0.50), 0.5 + 0.5 * n.z);
  float fill = max(dot(n, v), 0.0);
  vec3 light = vec3(1.02, 0.98, 0.92) * facing * shade + sky + vec3(0.10) * fill;
  vec3 halfway = normalize(sun_W + v);
  float rim = pow(1.0 - fill, 5.0);
  float sharp = mix(8.0, 160.0, gloss * gloss);
  float highlight = gloss * (0.35 * pow(max(dot(n, halfway), 0.0), sharp) * shade * (0.4 + gloss) + 0.22 * rim);
  vec3 albedo = paint.rgb;
  if (octants > 0.0) {
    vec3 side = clamp(octant / max(fwidth(octant), vec3(1e-7)), -1.0, 1.0);
    albedo *= 1.0 + octants * side.x * side.y * side.z;
  }
  if (edges > 0.0) {
    vec3 width = fwidth(edge);
    vec3 near = smoothstep(vec3(0.0), 1.4 * width, edge);
    albedo = mix(albedo * (1.0 - 0.75 * edges), albedo, min(near.x, min(near.y, near.z)));
  }
  vec3 radiance = mix(albedo * light + highlight, albedo, glow);
#if GRID
  radiance = mix(radiance, kLine, gridLine());
#endif
  colour = vec4(film(radiance), faded(paint.a));
}
#endif
)";

// Depths of all that hides the sun, as the sun sees it.
inline constexpr const char* kShadowVertexShader = R"(#version 330 core
layout(location = 0) in vec3 p_M;
uniform mat4 X_WM;
uniform mat4 world_to_sun;
void main() { gl_Position = world_to_sun * (X_WM * vec4(p_M, 1.0)); }
)";

// Draws nothing: the depth is all.
inline constexpr const char* kShadowFragmentShader = R"(#version 330 core
void main() {}
)";

// Whose a pixel is: the number of the thing in red and green.
inline constexpr const char* kThingFragmentShader = R"(#version 330 core
uniform int thing;
out vec4 colour;
void main() { colour = vec4(float(thing & 255) / 255.0, float(thing >> 8) / 255.0, 0.0, 1.0); }
)";

// A triangle that covers the picture.
inline constexpr const char* kSkyVertexShader = R"(#version 330 core
out float up;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  up = 0.5 + 0.5 * corner.y;
  gl_Position = vec4(corner, 1.0, 1.0);
}
)";

// The sky behind all: grey at the horizon, bluish above.
inline constexpr const char* kSkyFragmentShader = R"(#version 330 core
in float up;
out vec4 colour;
void main() { colour = vec4(mix(vec3(0.93, 0.935, 0.94), vec3(0.70, 0.755, 0.82), smoothstep(0.0, 1.0, up)), 1.0); }
)";

}  // namespace pincer::tasks
