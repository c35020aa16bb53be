// What is drawn while the host has not told the facts of the scene (host/view/scene_facts.hpp).
export const NO_FACTS = { length_m: 0, fixed: [], desk_height_m: null, gripper_m: null, equal_segments: true, EA_N: null };
