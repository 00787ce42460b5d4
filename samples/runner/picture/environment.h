// The photographer's studio around the scene: a soft sky for diffuse light, and softboxes that glass and metal mirror.
#pragma once

#include "scene.h"
#include "vector.h"

namespace runner {

// A light far away with a soft edge: a disc of `spread` radians about `direction`.
struct FarLight {
  Vector3 direction; // towards the light
  Vector3 colour;    // irradiance on a surface that faces it
  float spread = 0;
};

class Environment {
public:
  Environment(const SceneLight &light, Vector3 up);

  // Diffuse light from a direction, without the two far lights.
  Vector3 ambient(Vector3 direction) const;
  // What a mirror shows of that direction.
  Vector3 mirrored(Vector3 direction) const;
  // What the camera sees where there is nothing. `down` is 0 at the picture's top and 1 at its bottom.
  Vector3 background(float across, float down) const;

  Vector3 up() const { return up_; }
  const FarLight &key() const { return key_; }
  const FarLight &rim() const { return rim_; } // from behind and aside, cool: it parts matter from the background
  float exposure() const { return light_.exposure; }

private:
  SceneLight light_;
  Vector3 up_, front_, side_; // front: the key light's direction, levelled
  FarLight key_, rim_;
};

} // namespace runner
