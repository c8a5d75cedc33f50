// Camera matrices shared by all programs that draw in the scene.
// view: world to view space, millimetres; projection: view to clip space. Both column-major.
uniform mat4 view;
uniform mat4 projection;
