export {
  AmbientLight, Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, GridHelper, Group, HemisphereLight,
  Line, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshLambertMaterial, MeshPhongMaterial, OrthographicCamera, PerspectiveCamera, Plane, Points,
  PointsMaterial, Quaternion, Raycaster, Scene, Sphere, SphereGeometry, Vector2, Vector3, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
