// shaders_occlusion: the programs that darken corners and the surroundings of contacts
// by the depths in the picture, GLSL 3.30.
//
//   share of the sky that a place sees = 1 - mean over taps t of max(0, n.d_t - bias) /
//   (|d_t|^2 + small),   d_t = (p_t - p) / reach
//
// Source: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, The Alchemy screen-space ambient obscurance algorithm,
// HPG 2011. Places are in the camera's frame.
#pragma once

namespace pincer::tasks {

// How much light near things take from each pixel, by taps of the depths around it.
inline constexpr const char* kOcclusionFragmentShader = R"(#version 330 core
uniform sampler2D depths;
uniform mat4 clip_to_view;
uniform float reach;       // of what takes light away [m]
uniform float pixels;      // of a metre at a distance of a metre
out vec4 colour;

const int kTaps = 24;

vec3 placeAt(ivec2 pixel) {
  ivec2 size = textureSize(depths, 0);
  pixel = clamp(pixel, ivec2(0), size - 1);
  vec3 clip = vec3((vec2(pixel) + 0.5) / vec2(size), texelFetch(depths, pixel, 0).r) * 2.0 - 1.0;
  vec4 p = clip_to_view * vec4(clip, 1.0);
  return p.xyz / p.w;
}

// The slope towards the neighbour that lies on the same surface: the nearer in depth.
vec3 slope(vec3 p, ivec2 pixel, ivec2 way) {
  vec3 on = placeAt(pixel + way) - p, back = p - placeAt(pixel - way);
  return abs(on.z) < abs(back.z) ? on : back;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  if (texelFetch(depths, pixel, 0).r >= 1.0) {
    colour = vec4(1.0);
    return;
  }
  vec3 p = placeAt(pixel);
  vec3 n = normalize(cross(slope(p, pixel, ivec2(1, 0)), slope(p, pixel, ivec2(0, 1))));
  float turn = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  float radius = min(reach * pixels / -p.z, 160.0), taken = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    float angle = 2.39996323 * float(i) + turn, share = (float(i) + 0.5) / float(kTaps);
    vec3 d = (placeAt(pixel + ivec2(radius * share * vec2(cos(angle), sin(angle)))) - p) / reach;
    float far = dot(d, d);
    taken += far < 1.0 ? (1.0 - far) * max(0.0, dot(n, d) - 0.02) / (far + 0.02) : 0.0;
  }
  colour = vec4(vec3(max(0.0, 1.0 - 0.9 * taken / float(kTaps))), 1.0);
}
)";

// Takes the grain out: the mean of the 5 x 5 pixels around that lie as deep.
inline constexpr const char* kOcclusionBlurShader = R"(#version 330 core
uniform sampler2D depths;
uniform sampler2D light;
out vec4 colour;
void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), size = textureSize(light, 0);
  float here = 1.0 - texelFetch(depths, pixel, 0).r, sum = 0.0, weights = 0.0;
  for (int x = -2; x <= 2; ++x)
    for (int y = -2; y <= 2; ++y) {
      ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), size - 1);
      float weight = abs(1.0 - texelFetch(depths, at, 0).r - here) < 0.02 * here ? 1.0 : 0.0;
      sum += weight * texelFetch(light, at, 0).r;
      weights += weight;
    }
  colour = vec4(vec3(weights > 0.0 ? sum / weights : 1.0), 1.0);
}
)";

}  // namespace pincer::tasks
