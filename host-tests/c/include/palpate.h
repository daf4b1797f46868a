/**
 * @file palpate.h
 * @brief Feel a CAD surface from C: a body from a file, its closest point, and the whole servo tick.
 *
 * Nothing here allocates, waits or stops the program. All memory is the caller's, all work is bounded, and whatever is
 * wrong comes back as a ::palpate_status; then nothing has been done. Lengths are in metres, angles in radians, forces
 * in newtons, times in seconds, numbers in single precision. A body's numbers are in the frame of its tables, whose
 * origin lies in the model where palpate_file_info::centre says.
 *
 * **Handles** (::palpate_body, ::palpate_soft_body, ::palpate_tracker, ::palpate_pair, ::palpate_servo,
 * ::palpate_tool_servo, ::palpate_receiver) lie in memory of the caller's, static or on a stack, and are made by the function that takes
 * their size. What is in them is nobody's business. A handle stays where it was made: a copy elsewhere is refused with
 * #PALPATE_NOT_READY, as is memory that was never made a handle. A body that is loaded anew ends what stands on it.
 *
 * **What is checked**: each pointer for null and alignment, each length, each number that must be finite, each index,
 * the whole of a file. **What the caller promises**, for nobody can check it: a pointer that is not null points to as
 * much memory as the function says; a file, its buffer and a body stay as they are for as long as anything stands on
 * them; and no two calls that change a handle run at once.
 *
 * **What comes back**: #PALPATE_OK, or one of the values that a function names. Each may return #PALPATE_NULL and
 * #PALPATE_MISALIGNED for a pointer, #PALPATE_TOO_SMALL for memory, and #PALPATE_NOT_READY for a handle.
 *
 * **Interrupts**: a loop whose tick runs in an interrupt has every other call on it with that interrupt masked, or from
 * within it: palpate_servo_note(), palpate_servo_supply(), palpate_servo_index(), palpate_servo_set_feel(),
 * palpate_servo_orient(), palpate_servo_state() and the like.
 *
 * @code{.c}
 * static palpate_body body;
 * static palpate_word buffer[PALPATE_BODY_BUFFER_WORDS(6, 12)];
 * palpate_body_load(&body, sizeof body, part_palp, sizeof part_palp, buffer, sizeof buffer);
 * palpate_tracker tracker;
 * palpate_start(&tracker, sizeof tracker, &body);
 * const float probe[3] = {0.01f, 0.02f, 0.05f};
 * palpate_touch touch;
 * palpate_step(&tracker, probe, &touch);
 * @endcode
 */
#ifndef PALPATE_H
#define PALPATE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** @name Memory
 *  Words of the caller's memory that each handle takes.
 *  @{ */

/** What handles and rooms are made of: a word of the machine, at its alignment. */
typedef uintptr_t palpate_word;

#if UINTPTR_MAX == 0xffffffffu
#define PALPATE_FACE_WORDS 57
#define PALPATE_EDGE_WORDS 13
#define PALPATE_BODY_WORDS 28
#define PALPATE_MODE_WORDS 43
#define PALPATE_SOFT_BODY_WORDS 84
#define PALPATE_TRACKER_WORDS 76
#define PALPATE_PAIR_WORDS 56
#define PALPATE_SERVO_WORDS 500
#define PALPATE_TOOL_WORDS 2460
#define PALPATE_RECEIVER_WORDS 38
#else
#define PALPATE_FACE_WORDS 45
#define PALPATE_EDGE_WORDS 9
#define PALPATE_BODY_WORDS 23
#define PALPATE_MODE_WORDS 22
#define PALPATE_SOFT_BODY_WORDS 56
#define PALPATE_TRACKER_WORDS 40
#define PALPATE_PAIR_WORDS 32
#define PALPATE_SERVO_WORDS 260
#define PALPATE_TOOL_WORDS 1240
#define PALPATE_RECEIVER_WORDS 22
#endif

/** Words of the buffer of a body with so many faces and edges (palpate_file_info::faces, palpate_file_info::edges). */
#define PALPATE_BODY_BUFFER_WORDS(faces, edges) ((faces) * PALPATE_FACE_WORDS + (edges) * PALPATE_EDGE_WORDS)

/** A body: the tables of a file, checked. */
typedef struct palpate_body { palpate_word reserved[PALPATE_BODY_WORDS]; } palpate_body;
/** A body that gives way: a body and its modes. */
typedef struct palpate_soft_body { palpate_word reserved[PALPATE_SOFT_BODY_WORDS]; } palpate_soft_body;
/** The closest point of a body, followed from tick to tick. */
typedef struct palpate_tracker { palpate_word reserved[PALPATE_TRACKER_WORDS]; } palpate_tracker;
/** The closest pair of two faces. */
typedef struct palpate_pair { palpate_word reserved[PALPATE_PAIR_WORDS]; } palpate_pair;
/** A servo loop: device, body, settings and state. */
typedef struct palpate_servo { palpate_word reserved[PALPATE_SERVO_WORDS]; } palpate_servo;
/** A servo loop with a tool that has a shape: every function takes its member servo. */
typedef struct palpate_tool_servo { palpate_servo servo; palpate_word reserved[PALPATE_TOOL_WORDS]; } palpate_tool_servo;
/** Bytes of a frame on their way in. */
typedef struct palpate_receiver { palpate_word reserved[PALPATE_RECEIVER_WORDS]; } palpate_receiver;
/** @} */

/** What a call came to; palpate_status_text() has it in words. */
typedef int32_t palpate_status;

/** The values of ::palpate_status. */
enum {
    PALPATE_OK = 0,                        /**< Done. */
    PALPATE_NULL = 1,                      /**< A pointer is null. */
    PALPATE_MISALIGNED = 2,                /**< A pointer is not aligned for what it points to; a file needs 4. */
    PALPATE_TOO_SMALL = 3,                 /**< The memory given is too small. */
    PALPATE_NOT_READY = 4,                 /**< No handle, a moved one, or what it stands on was loaded anew. */
    PALPATE_NOT_FINITE = 5,                /**< A number is NaN or infinite. */
    PALPATE_OUT_OF_RANGE = 6,              /**< An index, a count or a code is out of its range. */
    PALPATE_FILE_MAGIC = 16,               /**< No body's file: it does not begin with PALP. */
    PALPATE_FILE_VERSION = 17,             /**< Of another version: bake it anew. */
    PALPATE_FILE_LENGTH = 18,              /**< More or fewer bytes than the file says. */
    PALPATE_FILE_DAMAGED = 19,             /**< Its CRC-32 is not the one it says. */
    PALPATE_FILE_SECTION = 20,             /**< A section is not where it should be, or its length does not fit. */
    PALPATE_FILE_NUMBER = 21,              /**< A number is not finite. */
    PALPATE_FILE_CODE = 22,                /**< A kind or flag that there is not. */
    PALPATE_FILE_MISSING = 23,             /**< A record needs numbers that are not there. */
    PALPATE_FILE_LEFT_OVER = 24,           /**< There are unused numbers. */
    PALPATE_FILE_PATCH = 25,               /**< A face is not one. */
    PALPATE_FILE_BODY = 26,                /**< The body is not one. */
    PALPATE_FILE_TABLES = 27,              /**< The tables are not those that were baked. */
    PALPATE_DEVICE_ENCODER = 32,           /**< Radians a count zero or not finite, or a zero not finite. */
    PALPATE_DEVICE_MOTOR = 33,             /**< Torque zero, not finite or above 200 N·m; or a feed without positive supply
                                                and resistance, or with a back_emf_share outside 0 to 1. */
    PALPATE_DEVICE_FRICTION = 34,          /**< Dry friction negative, not finite or above its motor's torque. */
    PALPATE_DEVICE_RANGE = 35,             /**< A least angle not below the greatest, an angle beyond two turns (20 of an only
                                                joint), or no whole counts a turn. */
    PALPATE_DEVICE_LIMIT = 36,             /**< A limit of the whole device not positive and finite, a margin above 10 m/rad, a
                                                force above 1,000 N. */
    PALPATE_DEVICE_MECHANISM = 37,         /**< A length not 0.001 to 2 m, an offset beyond 2 m, a side not 1 or -1, a direction
                                                not of length 1. */
    PALPATE_DEVICE_CENTRE = 38,            /**< The workspace's centre out of the mechanism's reach. */
    PALPATE_DEVICE_MASS = 39,              /**< A mass of the mechanism negative or not finite. */
    PALPATE_DEVICE_WEIGHT = 40,            /**< Links heavier than a motor holds, under protection for long. */
    PALPATE_SETTINGS_RATE = 48,            /**< Rate not between 20 Hz and 100 kHz. */
    PALPATE_SETTINGS_STIFFNESS = 49,       /**< Stiffness not between 0 and the device's greatest. */
    PALPATE_SETTINGS_DAMPING = 50,         /**< Damping not between 0 and the device's greatest. */
    PALPATE_SETTINGS_MAX_FORCE = 51,       /**< Greatest force negative or not finite. */
    PALPATE_SETTINGS_VELOCITY_CORNER = 52, /**< Velocity corner not positive and finite. */
    PALPATE_SETTINGS_SOFT_START = 53,      /**< Soft start negative or not finite. */
    PALPATE_SETTINGS_BODY_ORIGIN = 54,     /**< Origin not finite. */
    PALPATE_SETTINGS_FRICTION = 55,        /**< Friction negative, not finite, or dynamic above static. */
    PALPATE_SETTINGS_MAX_SLEW = 56,        /**< Slew limit not positive. */
    PALPATE_SETTINGS_SAFE_DAMPING = 57,    /**< Safe damping not between 0 and the device's greatest. */
    PALPATE_SETTINGS_LINK_TIMEOUT = 58,    /**< Timeout not positive. */
    PALPATE_SETTINGS_TEXTURE = 59,         /**< No texture was given, or its share is not between 0 and 1. */
    PALPATE_SETTINGS_COUPLING = 60,        /**< The virtual tool too light: not stiffness + coupling_stiffness < 2 * coupling_mass *
                                                rate², coupling_stiffness not positive, or coupling_damping negative. */
    PALPATE_SETTINGS_PASSIVITY = 61,       /**< A number of passivity control negative or not finite, or its resolution 0. */
    PALPATE_SETTINGS_EASE = 62,            /**< Easing's onset negative or not finite, or its change not positive. */
    PALPATE_PROTECTION_CONTINUOUS = 64,    /**< A motor's continuous torque not positive and finite. */
    PALPATE_PROTECTION_TIME_CONSTANT = 65, /**< A time constant not between 100 and 2,400,000 ticks, or above ten minutes. */
    PALPATE_PROTECTION_SPEED = 66,         /**< A maximum speed not positive, above 10 m/s or 500 rad/s. */
    PALPATE_PROTECTION_SUPPLY = 67,        /**< The minimum supply not below the maximum. */
    PALPATE_PROTECTION_INERTIA = 68,       /**< An inertia not positive and finite. */
    PALPATE_HOMING_ANGLE = 72,             /**< A reference angle not finite. */
    PALPATE_HOMING_STILL = 73,             /**< No tick to hold still for. */
    PALPATE_HOMING_STOP = 74,              /**< A stop's speed 0, its torque, clearance or travel not positive, or one not finite. */
    PALPATE_HOMING_TIMEOUT = 75,           /**< No more time than it is to hold still. */
    PALPATE_HOMING_STARTED = 76,           /**< The loop has ticked already. */
    PALPATE_SOFT_MODES = 80,               /**< No modes, or more than #PALPATE_MAX_MODES. */
    PALPATE_SOFT_MODE = 81,                /**< A limit, a bound or a bump's radius negative. */
    PALPATE_SOFT_MOTION = 82,              /**< Stiffness not positive, mass or damping negative, or too fast. */
    PALPATE_SOFT_RATE = 83,                /**< The modes' rate not positive and finite. */
    PALPATE_SOFT_NONE = 84,                /**< The loop's body has no modes. */
    PALPATE_KNOB_NONE = 88,          /**< The loop renders no dial. */
    PALPATE_KNOB_DETENTS = 89,       /**< Detents: a pitch outside 1e-4 rad to half a turn, or another wrong number. */
    PALPATE_KNOB_CLICKS = 90,        /**< Clicks: the same, or a snap outside 0.5 to 1. */
    PALPATE_KNOB_TEXTURE = 91,       /**< A texture: as detents. */
    PALPATE_KNOB_SPRING = 92,        /**< A spring with a negative number, or one not finite. */
    PALPATE_KNOB_ENDS = 93,          /**< End stops out of order, or a negative number. */
    PALPATE_KNOB_DAMPING = 94,       /**< Damping negative or not finite. */
    PALPATE_KNOB_FRICTION = 95,      /**< Friction: torque negative, or rate not positive. */
    PALPATE_KNOB_NOTCH = 96,         /**< A notch: a width outside 1e-4 rad to half a turn, or another wrong number. */
    PALPATE_KNOB_MAX_STIFFNESS = 97, /**< All parts: stiffer than max_stiffness times radius squared. */
    PALPATE_KNOB_MAX_DAMPING = 98,   /**< All parts: more damping than max_damping times radius squared. */
    PALPATE_KNOB_MAX_TORQUE = 99,    /**< All parts: more torque than max_force times radius. */
    PALPATE_KNOB_RELEASE_RATE = 100, /**< Release rate not positive and finite. */
    PALPATE_KNOB_FAR = 101,          /**< The part would take the dial further than an eighth of a turn. */
    PALPATE_KNOB_UNDAMPED = 102,     /**< All parts: too stiff for their damping, the dial would ring. */
    PALPATE_KNOB_MARGIN = 103,       /**< palpate_device::min_margin: above 0.8 of the dial's radius. */
    PALPATE_TOOL_NONE = 104,         /**< The loop has no tool with a shape. */
    PALPATE_TOOL_MEMORY = 105,       /**< A loop with a tool needs a ::palpate_tool_servo: its member servo, the size of all of it. */
    PALPATE_TOOL_HALF = 106,         /**< A half length not 0 to 1e6 m. */
    PALPATE_TOOL_RADIUS = 107,       /**< The tool's radius not 0 to 1e6 m. */
    PALPATE_TOOL_THIN = 108,         /**< The tool's radius 0, or below a hundredth of its largest half length. */
    PALPATE_TOOL_FRICTION = 109,     /**< The tool's friction not 0 to 2. */
    PALPATE_TOOL_STIFFNESS = 110,    /**< Settings with a tool: stiffness or rate not positive and finite. */
    PALPATE_TOOL_POINT_FRICTION = 111, /**< Settings with a tool: friction_static or friction_dynamic not 0. */
    PALPATE_TOOL_TEXTURE = 112,      /**< Settings with a tool: texture_share not 0. */
    PALPATE_TOOL_COUPLING = 113,     /**< Settings with a tool: coupling_mass not 0. */
    PALPATE_TOOL_ROTATION = 114,     /**< An orientation that is no quaternion of length 1. */
    PALPATE_WRIST_NUMBERS = 115,     /**< An axis not of length 1 or along the one before, or another number that no wrist has. */
    PALPATE_WRIST_RANGE = 116,       /**< An axis of the wrist is out of its range. */
    PALPATE_WRIST_JUMP = 117,        /**< An axis of the wrist has jumped. */
    PALPATE_KNOB_MOTOR = 118         /**< All parts: more torque than palpate_joint::torque_at_full, which is the lesser limit. */
};

/** Returns a status in a sentence, a static string; "unknown" of a code that is none. */
const char *palpate_status_text(int32_t status);
/** palpate_output::fault and palpate_state::fault; 0 is none. A fault is latched: only a new start leaves it, and after
 *  #PALPATE_FAULT_WATCHDOG_RESET and #PALPATE_FAULT_BROWN_OUT palpate_servo_note() with #PALPATE_ACKNOWLEDGED. */
enum {
    PALPATE_FAULT_FRAME_LOST = 1,            /**< Sensor frame lost or late. */
    PALPATE_FAULT_FRAME_DAMAGED = 2,         /**< Sensor frame damaged. */
    PALPATE_FAULT_JOINT_OUT_OF_RANGE = 3,    /**< Joint angle out of range. */
    PALPATE_FAULT_JOINT_JUMPED = 4,          /**< Joint angle jumped. */
    PALPATE_FAULT_NOT_FINITE = 5,            /**< Force not finite. */
    PALPATE_FAULT_JOINT_STUCK = 6,           /**< Joint sensor stuck. */
    PALPATE_FAULT_OVERRUN = 7,               /**< Tick overrun. */
    PALPATE_FAULT_LINK_LOST = 8,             /**< Host link lost. */
    PALPATE_FAULT_TABLE_CORRUPT = 9,         /**< Table corrupted. */
    PALPATE_FAULT_WATCHDOG_RESET = 10,       /**< Reset by the watchdog. */
    PALPATE_FAULT_BROWN_OUT = 11,            /**< Reset by a brown-out. */
    PALPATE_FAULT_DRIVE = 12,                /**< Motor driver fault. */
    PALPATE_FAULT_HOMING = 13,               /**< Homing refused. */
    PALPATE_FAULT_STOPPED = 14,              /**< Stopped by hand. */
    PALPATE_FAULT_UNREACHABLE = 15,          /**< Pose out of the mechanism's reach. */
    PALPATE_FAULT_CONTACT_LOST = 16,         /**< Contact lost repeatedly. */
    PALPATE_FAULT_OVERSPEED = 17,            /**< Moving too fast under force. */
    PALPATE_FAULT_SUPPLY = 18,               /**< Motor supply out of range or not measured. */
    PALPATE_FAULT_WRONG_POLARITY = 19,       /**< Encoder and motor polarity disagree. */
    PALPATE_FAULT_CALIBRATION = 20,          /**< The calibration stored in flash is refused. */
    PALPATE_FAULT_MAGNET = 21,               /**< Sensor magnet too strong or too weak. */
    PALPATE_FAULT_FROZEN = 22,               /**< Sensor reading frozen. */
    PALPATE_FAULT_OTHER_RATE = 23            /**< Surface made for another rate. */
};

/** Returns a fault (palpate_output::fault) in words, a static string; "none" of 0, "unknown" of any other code. */
const char *palpate_fault_text(uint32_t fault);

/** Returns a refusal of homing (palpate_state::refusal) in words, a static string; "none" of 0, "unknown" of any other code. */
const char *palpate_refusal_text(uint32_t refusal);

/** @name Bodies
 *  @{ */

/** What a file says of itself. */
typedef struct palpate_file_info {
    uint32_t faces;      /**< Faces of the body. */
    uint32_t edges;      /**< Edges of the body. */
    uint32_t buffer_bytes; /**< Bytes of the buffer that it needs on this machine. */
    float centre[3];     /**< Where the origin of the tables lies in the model, m. */
    uint8_t source[32];  /**< SHA-256 of the model file. */
} palpate_file_info;

/** Where the closest point of a body lies. */
typedef struct palpate_located {
    uint32_t face;        /**< The face. */
    float parameters[2];  /**< (u, v) on it, 0 to 1. */
    float point[3];       /**< The point, m. */
    float distance;       /**< From the probe, m; never negative. */
    uint32_t evaluations; /**< Evaluations of patches spent. */
    uint32_t complete;    /**< 1 if every candidate was searched to its end. */
} palpate_located;

/**
 * Looks at a file: its CRC and its sections. The size of the buffer that a body needs is known then.
 *
 * @param file  the bytes that `palpate bake MODEL --out part.palp` wrote, at a multiple of 4
 * @param bytes how many
 * @param info  where what it says goes
 * @return #PALPATE_OK, or #PALPATE_FILE_MAGIC to #PALPATE_FILE_SECTION.
 */
palpate_status palpate_file_head(const uint8_t *file, size_t bytes, palpate_file_info *info);

/**
 * Makes a body of a file, with everything in it checked. The numbers are read where they lie: file and buffer stay as
 * they are for as long as the body is used. The time is bounded by the length of the file. On a Cortex-M4F this takes
 * less than 2 KB of stack, the start of an arm's loop less than 6 KB, its tick less than 2 KB.
 *
 * @param body        where the body goes
 * @param body_bytes  `sizeof` it
 * @param file        the file, at a multiple of 4
 * @param file_bytes  its length
 * @param buffer memory for faces and edges, at the alignment of ::palpate_word
 * @param buffer_bytes  `sizeof` it; palpate_file_info::buffer_bytes at least
 * @return #PALPATE_OK, or #PALPATE_FILE_MAGIC to #PALPATE_FILE_TABLES; then there is no body.
 */
palpate_status palpate_body_load(palpate_body *body, size_t body_bytes, const uint8_t *file, size_t file_bytes,
                                 void *buffer, size_t buffer_bytes);

/**
 * The closest point from a standing start. At most 512 evaluations of patches, on a convex body 32.
 *
 * @param body    the body
 * @param probe   three coordinates, m
 * @param located where the answer goes
 * @return #PALPATE_OK, or #PALPATE_NOT_FINITE of the probe.
 */
palpate_status palpate_closest(const palpate_body *body, const float *probe, palpate_located *located);
/** @} */

/** @name Bodies that give way
 *  A servo loop moves their modes under the push: palpate_servo_start_serial_arm_soft() and the like.
 *  @{ */

/** Modes of a body at most. */
#define PALPATE_MAX_MODES 8

/** A mode and its motion. `modes.py` writes an array of them from what `palpate bake --soft` wrote. */
typedef struct palpate_mode {
    float constant[3];       /**< Displacement at the origin of the tables, metres per metre of q. */
    float linear[3][3];      /**< Of x, y, z, 1/m. */
    float quadratic[6][3];   /**< Of xx, xy, xz, yy, yz, zz, 1/m². */
    float bump_direction[3]; /**< A local displacement that is added, metres per metre of q at its middle. */
    float bump_at[3];        /**< Its middle, m. */
    float bump_radius;       /**< m; 0: none. */
    float limit;             /**< Maximum of |q|, m. */
    float motion;            /**< Bound of the displacement over the body, a metre of q. */
    float stretch;           /**< Bound of its first derivative, 1/m. */
    float bend;              /**< Of the second one, 1/m². */
    float twist;             /**< Of the third one, 1/m³. */
    float mass;              /**< Modal mass, kg; 0: no inertia. */
    float damping;           /**< N·s/m; 0 as well as the mass: it follows the force at once. */
    float stiffness;         /**< N/m. */
} palpate_mode;

/**
 * Gives a body modes, each checked. They are copied into the buffer; body and buffer stay as they are for as long as
 * the soft body is used.
 *
 * @param soft         where the soft body goes
 * @param soft_bytes   `sizeof` it
 * @param body         the body, at rest
 * @param modes        its modes, as they were baked for this body
 * @param count        how many, 1 to #PALPATE_MAX_MODES
 * @param rate         rate of the loop, Hz; in a loop of another rate it is a fault
 * @param buffer       memory for the modes, at the alignment of ::palpate_word
 * @param buffer_bytes `sizeof` it; #PALPATE_MODE_WORDS words a mode
 * @return #PALPATE_OK, #PALPATE_NOT_FINITE, or #PALPATE_SOFT_MODES to #PALPATE_SOFT_RATE.
 */
palpate_status palpate_soft_body_load(palpate_soft_body *soft, size_t soft_bytes, const palpate_body *body,
                                      const palpate_mode *modes, size_t count, float rate, void *buffer,
                                      size_t buffer_bytes);
/** @} */

/** @name Trackers
 *  @{ */

/** What is known of the closest point after a tick. */
typedef struct palpate_touch {
    float point[3];       /**< The witness point, m. */
    float normal[3];      /**< Unit vector out of the body there. */
    float gap;            /**< Along it, m; negative inside. */
    float parameters[2];  /**< (u, v) on a face, (t, 0) on an edge. */
    uint32_t feature;     /**< The index of a face, of an edge plus 0x4000, of a vertex plus 0x8000. */
    uint32_t contact;     /**< 0 behind the surface, 1 in front of it, 2 touching. */
    uint32_t located;     /**< 1 once it is known where the closest point is; until then nothing is touched. */
    uint32_t rejected;      /**< 1 if the step was rejected because the distance would have risen. */
    uint32_t searched;    /**< 1 if the tick went to the search for a global start. */
    uint32_t unexplained; /**< 1 if it is farther off than the probe has moved since contact began. */
    uint32_t too_deep;    /**< 1 if deeper inside than the face's minimum radius of curvature: not the only closest point. */
    uint32_t evaluations; /**< Evaluations of patches spent in the tick. */
} palpate_touch;

/**
 * Makes a tracker that knows nothing yet: its first ticks search.
 *
 * @param tracker       where it goes
 * @param tracker_bytes `sizeof` it
 * @param body          the body, which stays
 * @return #PALPATE_OK.
 */
palpate_status palpate_start(palpate_tracker *tracker, size_t tracker_bytes, const palpate_body *body);

/**
 * Makes a tracker whose witness point lies on a face.
 *
 * @param tracker       where it goes
 * @param tracker_bytes `sizeof` it
 * @param body          the body, which stays
 * @param face          the face
 * @param u             first parameter, 0 to 1
 * @param v             second parameter, 0 to 1
 * @return #PALPATE_OK, #PALPATE_OUT_OF_RANGE of the face, or #PALPATE_NOT_FINITE.
 */
palpate_status palpate_start_on(palpate_tracker *tracker, size_t tracker_bytes, const palpate_body *body,
                                uint32_t face, float u, float v);

/**
 * Moves the witness point towards the point closest to the probe: one evaluation of a patch. palpate_update_contact() follows.
 *
 * @param tracker the tracker
 * @param probe   three coordinates, m
 * @return #PALPATE_OK, or #PALPATE_NOT_FINITE of the probe.
 */
palpate_status palpate_track(palpate_tracker *tracker, const float *probe);

/**
 * Normal, gap and contact for the probe of the last palpate_track().
 *
 * @param tracker the tracker
 * @param touch   where the answer goes
 * @return #PALPATE_OK; #PALPATE_NOT_READY before the first palpate_track().
 */
palpate_status palpate_update_contact(palpate_tracker *tracker, palpate_touch *touch);

/**
 * A whole tick: palpate_track(), then palpate_update_contact(), and how far the probe has gone since contact began.
 *
 * @param tracker the tracker
 * @param probe   three coordinates, m
 * @param touch   where the answer goes
 * @return #PALPATE_OK, or #PALPATE_NOT_FINITE of the probe.
 */
palpate_status palpate_step(palpate_tracker *tracker, const float *probe, palpate_touch *touch);
/** @} */

/** @name Pairs
 *  @{ */

/** Where the second body stands in the frame of the first, and how it moves. */
typedef struct palpate_pose {
    float axes[3][3];          /**< Its axes, orthonormal and right-handed, one a row. */
    float origin[3];           /**< Its origin, m. */
    float velocity[3];         /**< Velocity of its origin, m/s. */
    float angular_velocity[3]; /**< Angular velocity, rad/s. */
} palpate_pose;

/** What is known of a pair after a step. */
typedef struct palpate_apart {
    float first[3];             /**< On the first face, in its body's frame, m. */
    float second[3];            /**< On the second face, in its own body's frame, m. */
    float difference[3];        /**< First less second, in the first body's frame, m. */
    float distance;             /**< Its length, m. */
    float first_parameters[2];  /**< (u, v) on the first face. */
    float second_parameters[2]; /**< (u, v) on the second face. */
} palpate_apart;

/**
 * Makes a pair with its points in the middle of two faces.
 *
 * @param pair        where it goes
 * @param pair_bytes  `sizeof` it
 * @param first       a body, which stays
 * @param first_face  one of its faces
 * @param second      the other body, or the same
 * @param second_face one of its faces
 * @return #PALPATE_OK, or #PALPATE_OUT_OF_RANGE of a face.
 */
palpate_status palpate_pair_start(palpate_pair *pair, size_t pair_bytes, const palpate_body *first,
                                  uint32_t first_face, const palpate_body *second, uint32_t second_face);

/**
 * One step towards the closest pair of two faces that do not intersect: one evaluation of each. The distance never
 * rises by more than rounding.
 *
 * @param pair  the pair
 * @param pose  where the second body is
 * @param apart where the answer goes
 * @return #PALPATE_OK, or #PALPATE_NOT_FINITE of the pose.
 */
palpate_status palpate_pair_step(palpate_pair *pair, const palpate_pose *pose, palpate_apart *apart);
/** @} */

/** @name A device from numbers
 *  @{ */

/** How a bridge that gives a voltage feeds a motor. All zero: the amplifier controls the current. */
typedef struct palpate_voltage_feed {
    float supply;          /**< Voltage at full duty, V, positive; 0 for a current-controlled amplifier. */
    float resistance;      /**< Of winding, brushes and bridge, ohms, positive with a supply. */
    float torque_constant; /**< N·m/A. */
    float current_at_full; /**< Current that full duty of torque stands for, A. */
    float ratio;           /**< Turns of the motor for one of the joint. */
    float back_emf_share;  /**< How much of the back-EMF is made up for, 0 to 1. */
} palpate_voltage_feed;

/** A joint: encoder, motor, range. */
typedef struct palpate_joint {
    float radians_per_count;   /**< Joint angle a count, rad, not 0; negative where it counts the other way. */
    float angle_at_line;       /**< Joint angle where the count steps from -1 to 0, rad; as Encoder::new in Rust. */
    float torque_at_full;      /**< Joint torque at full duty, N·m, not 0, at most 200; negative where the motor turns the other way. */
    float dry_friction;        /**< N·m, generously, 0 to |torque_at_full|; 0 where it is not known. */
    float least_angle;         /**< Minimum, rad, within two turns, 20 of an only joint; below it is a sensor fault. */
    float greatest_angle;      /**< Maximum, rad, above it, within the same; above this a sensor fault. */
    palpate_voltage_feed feed; /**< How the motor is fed. */
} palpate_joint;

/** A device, all but its mechanism. Joints that it does not have are not looked at. */
typedef struct palpate_device {
    palpate_joint joints[3]; /**< Its joints. */
    float min_margin;        /**< Minimum distance from a singularity, m/rad, above 0 to 10, below it no force. An arm's links scale
                                  it (0.05 where they are 0.2 m); a dial's at most 0.8 of its radius, such as half. */
    float max_joint_rate;    /**< Maximum plausible joint speed, rad/s, positive; faster is a sensor fault. */
    float max_force;         /**< N, above 0 to 1,000. */
    float max_stiffness;     /**< N/m, positive. */
    float max_damping;       /**< N·s/m, positive. */
} palpate_device;

/**
 * A turntable with a parallelogram of two links: WoodenHaptics, Phantom. Three joints.
 *
 * In every mechanism lengths are 0.001 to 2 m, offsets -2 to 2 m, and the workspace's centre is not farther from where
 * the links start than they reach: else #PALPATE_DEVICE_MECHANISM, #PALPATE_DEVICE_CENTRE. The device's frame, in which
 * palpate_settings::body_origin is and palpate_state::force acts, has its origin in the workspace's centre; here x
 * points away from the turntable at joint angle 0, z up.
 *
 * Each motor must hold the links' weight: 9.81 * |end_masses[i]| * link <= |torque_at_full|, with protection times
 * palpate_endurance::continuous, at most 1; else #PALPATE_DEVICE_WEIGHT. The other mechanisms in the same way.
 */
typedef struct palpate_serial_arm {
    float base_height;         /**< Height of the first link's axis, an offset, m. */
    float first_link;          /**< Length, m. */
    float second_link;         /**< Length, m. */
    float workspace_centre[3]; /**< From the foot of the turntable, m. */
    float end_masses[2];       /**< What each link lifts, as a mass at its end, kg; 0 if not known, negative if overbalanced. */
} palpate_serial_arm;

/** Three legs with parallelograms: Falcon. Three joints. Each holds `carried_mass * thigh + |thigh_moment|`. Frame: z out of the base. */
typedef struct palpate_delta {
    float thigh;               /**< Length, m. */
    float shin;                /**< Length, m. */
    float stub;                /**< Both stubs together, m; 0 to 2. */
    float reach;               /**< Offset: from the axis out to a hip, less the same from the probe to a shin's end, m. */
    float side;                /**< The same difference to the left of a leg, m. */
    float directions[3][2];    /**< Cosine and sine of each leg's direction. */
    float workspace_centre[3]; /**< From the middle of the base, m. */
    float up[3];               /**< Which way is up, a unit vector. */
    float carried_mass;        /**< Mass that hangs on the probe, kg; 0 if not known, never negative. */
    float thigh_moment;        /**< Mass of a thigh times its lever, kg·m; 0 if not known. */
} palpate_delta;

/** Two cranks and two rods in a plane: Haply. Two joints. Frame: x along the pivots, z off the plane. */
typedef struct palpate_five_bar {
    float second_pivot;        /**< The second crank's pivot on the x axis, an offset, m. */
    float cranks[2];           /**< Lengths, m. */
    float rods[2];             /**< Lengths, m. */
    float side;                /**< 1 or -1: which way the rods bend. */
    float tool;                /**< The probe on the first rod, m from its elbow, negative beyond it: a length either way. */
    float workspace_centre[2]; /**< From the first pivot, m. */
} palpate_five_bar;

/**
 * A turntable that carries an upright five-bar: Polhem. Three joints. Frame: x away from the turntable, z up. Weight
 * with m, c for the mass and along + across of masses: the first crank's motor holds `m0 c0 + m2 cranks[0] + m3 c3
 * cranks[0] / rods[1]`, the second's `m1 c1 + m3 cranks[1] + m2 c2 cranks[1] / rods[0]`.
 */
typedef struct palpate_linkage_arm {
    palpate_five_bar linkage;  /**< In the upright plane; its own workspace centre is not used. */
    float pivot_reach;         /**< From the turntable's axis to the first crank's pivot, an offset, m. */
    float workspace_centre[3]; /**< From the foot of that pivot on the axis, m. */
    float masses[4][3];        /**< First crank, second crank, first rod, second rod: mass (kg, not negative), along, across (m). */
} palpate_linkage_arm;

/** A lever with one motor: Hapkit. One joint. */
typedef struct palpate_paddle {
    float handle;      /**< Length from the axis to the hand, m; the probe is at `handle * angle` on x. */
    float mass_moment; /**< Mass times the height of its centre over the axis, kg·m; 0 if balanced or not known. */
} palpate_paddle;

/** A dial with one motor, whose driver commutates by itself: a knob. One joint, the only one that may turn without end. */
typedef struct palpate_dial {
    float radius;       /**< Of the rim, a length, m; the device's limits of force are at the rim. */
    float release_rate; /**< How fast the torque of an old feel is let go of, N·m/s; positive. */
} palpate_dial;

/** A torque on a dial that repeats: `-torque * sin(2 pi (angle - centre) / pitch)`. */
typedef struct palpate_wave {
    float pitch;  /**< From one detent to the next, rad, 1e-4 to half a turn. */
    float torque; /**< Maximum, N·m. */
    float centre; /**< Where one detent is, rad, within a turn. */
} palpate_wave;

/** Detents of a dial that snap, numbered; detent 0 is at angle 0. */
typedef struct palpate_clicks {
    float pitch;          /**< From one to the next, rad, 1e-4 to half a turn. */
    float stiffness;      /**< N·m/rad. */
    float damping;        /**< N·m·s/rad. */
    float snap;           /**< How far out the next one takes over, in pitches, 0.5 to 1. */
    int32_t first;        /**< The first detent. */
    int32_t last;         /**< The last detent. */
    float wall_stiffness; /**< Beyond either, N·m/rad. */
    float max_torque;     /**< N·m. */
} palpate_clicks;

/** A spring that turns a dial back. */
typedef struct palpate_spring {
    float stiffness;  /**< N·m/rad. */
    float rest;       /**< Where it rests, rad. */
    float max_torque; /**< N·m. */
} palpate_spring;

/** End stops of a dial. */
typedef struct palpate_ends {
    float between[2]; /**< Where they are, rad. */
    float stiffness;  /**< N·m/rad. */
    float damping;    /**< N·m·s/rad; it only pushes. */
} palpate_ends;

/** Dry friction of a dial. */
typedef struct palpate_dial_friction {
    float torque;   /**< N·m. */
    float whole_at; /**< Rate from which on it is whole, rad/s; below, it is damping. */
} palpate_dial_friction;

/** A click of a dial at one position. */
typedef struct palpate_notch {
    float at;     /**< Where, rad. */
    float width;  /**< From one side to the other, rad, 1e-4 to half a turn. */
    float torque; /**< Maximum, N·m. */
} palpate_notch;

/** The feel of a dial, a sum of parts. A part whose numbers are all 0 is none: `{0}` turns freely. */
typedef struct palpate_feel {
    palpate_wave detents;           /**< Detents that one turns through smoothly. */
    palpate_clicks clicks;          /**< Detents that snap. */
    palpate_wave texture;           /**< Texture between detents. */
    palpate_spring spring;          /**< A spring. */
    palpate_ends ends;              /**< End stops. */
    float damping;                  /**< Everywhere, N·m·s/rad: at least 0.0007 s times the stiffness of the parts; of clicks
                                         and end stops only what their own damping leaves of it. */
    palpate_dial_friction friction; /**< Dry friction. */
    palpate_notch notch;            /**< A click at one position. */
} palpate_feel;

/** The parts of palpate_servo_set_feel(). */
enum {
    PALPATE_FEEL_FREE = 0,     /**< No part is left. */
    PALPATE_FEEL_DETENTS = 1,  /**< palpate_feel::detents. */
    PALPATE_FEEL_CLICKS = 2,   /**< palpate_feel::clicks. */
    PALPATE_FEEL_TEXTURE = 3,  /**< palpate_feel::texture. */
    PALPATE_FEEL_SPRING = 4,   /**< palpate_feel::spring. */
    PALPATE_FEEL_ENDS = 5,     /**< palpate_feel::ends. */
    PALPATE_FEEL_DAMPING = 6,  /**< palpate_feel::damping. */
    PALPATE_FEEL_FRICTION = 7, /**< palpate_feel::friction. */
    PALPATE_FEEL_NOTCH = 8     /**< palpate_feel::notch. */
};

/** A number that was refused, beside its limit: N·m/rad, N·m·s/rad, N·m or rad, by the status. */
typedef struct palpate_beyond {
    float asked; /**< The sum of the parts, how far the dial would be turned, or the damping everywhere. */
    float limit; /**< Of device or motor, an eighth of a turn, or the damping that is needed everywhere. Both are 0 where the status needs no number. */
} palpate_beyond;

/** A dial after a tick. */
typedef struct palpate_turned {
    int32_t turns;  /**< Whole turns that the angle does not count: at first it is within half a turn, and it stays within
                         some 260 turns. Both together never jump. */
    float angle;    /**< By which all parts of the feel are placed, rad; only where whole turns are taken out does it jump. */
    float torque;   /**< Of the feel, N·m, before soft start and limits. */
    int32_t detent; /**< The nearest detent or click to the angle. */
    int32_t end;    /**< -1 below the end stops, 1 above, 0 between them. */
} palpate_turned;

/**
 * A tool with a shape: a core, and a ball that rolls on it. Its frame has its origin in the probe, about which the handle
 * turns. Half lengths of the core: all 0 a ball, x and y 0 a finger along z, else a box.
 */
typedef struct palpate_tool {
    float half[3];  /**< m, not negative. */
    float radius;   /**< Of the ball, m, positive; at least a hundredth of the largest half length. */
    float friction; /**< Coefficient of dry friction, 0 to 2. */
} palpate_tool;

/** A gimbal: three axes that meet in the probe, from the arm to the handle, with an encoder each. */
typedef struct palpate_wrist {
    float axes[3][3];           /**< Unit vectors in the frame of the arm's last link, of the pose whose angles are 0. */
    float radians_per_count[3]; /**< As palpate_joint::radians_per_count. */
    float angle_at_line[3];     /**< As palpate_joint::angle_at_line. */
    float range[3][2];          /**< Minimum and maximum angle, rad. */
    float max_rate;             /**< Maximum plausible speed of an axis, rad/s, positive. */
} palpate_wrist;

/** palpate_held::given_up. */
enum {
    PALPATE_GIVEN_UP_INSIDE = 1, /**< The tool lies in the body: no force until it was outside. */
    PALPATE_GIVEN_UP_LOST = 2    /**< The contacts are not located (again) yet: if it stays, the orientation is missing, older
                                      than 20 ms, or turns faster than a hand. */
};

/** The contacts of a tool after a tick. */
typedef struct palpate_held {
    uint32_t located;     /**< 1 if all are known. Until then there is no force, and the tool can pass into the body. */
    uint32_t given_up;    /**< Why there is no contact, such as #PALPATE_GIVEN_UP_INSIDE; 0: there may be. */
    float orientation[4]; /**< The last one that was noted, x, y, z, w. */
} palpate_held;

/** A loop's settings. Begin with palpate_settings_recommended(). Numbers of a feature that is off must be finite, too. */
typedef struct palpate_settings {
    float rate;               /**< Servo rate, Hz, 20 to 100,000. */
    float stiffness;          /**< N/m, 0 to palpate_device::max_stiffness. */
    float damping;            /**< N·s/m, 0 to palpate_device::max_damping. */
    float max_force;          /**< N, not negative; the device's own limit applies as well. */
    float velocity_corner;    /**< Of the low-pass of velocities, Hz, positive. */
    float soft_start;         /**< Seconds over which the force is faded in, not negative. */
    float body_origin[3];     /**< Where the origin of the body's tables (the model's plus palpate_file_info::centre) lies in
                                   the device's frame, m. That frame's own origin is the mechanism's workspace_centre. */
    float friction_stiffness; /**< Along the surface while it sticks, N/m, not negative. */
    float friction_damping;   /**< The same, N·s/m, not negative. */
    float friction_static;    /**< Coefficient of static friction, not negative; with the next one 0: no friction. */
    float friction_dynamic;   /**< Coefficient of dynamic friction, 0 to the static one. */
    float texture_share;      /**< The texture's force at most, as a share of the normal force, 0 to 1; 0: none. */
    float coupling_stiffness; /**< Between probe and virtual tool, N/m, positive; with the wall below 2 * mass * rate². */
    float coupling_damping;   /**< N·s/m, not negative. */
    float coupling_mass;      /**< Of the virtual tool, kg; 0: the probe itself touches. */
    float passivity_damping;  /**< The most that passivity control adds, N·s/m, not negative; 0: none. */
    float passivity_resolution; /**< How far the probe seems to move when every encoder counts one, m, positive. */
    float device_damping;     /**< What the device has at least, for passivity control, N·s/m, not negative; 0 to be careful. */
    float device_friction;    /**< The same of dry friction, N, not negative. */
    float ease_onset;         /**< Push over which the damping comes in, N, not negative. */
    float ease_change;        /**< How fast a force may change that no motion explains, N/s, not negative; 0: no easing. */
    float max_slew;           /**< How fast the force may grow, N/s, positive; INFINITY for no limit. */
    float safe_damping;       /**< What the motors brake with after a fault, N·s/m, 0 to palpate_device::max_damping; 0: nothing. */
    float link_timeout;       /**< Seconds of silence after which the host is lost, positive; INFINITY where none watches. */
    uint32_t max_overruns;    /**< Ticks in a row that may overrun before it is a fault, any number; 0: the first is one. */
    uint32_t settle_ticks;    /**< Ticks of believable sensors before the loop is armed, any number; 0 is as 1. */
    uint32_t wait_for_homing; /**< 0, or 1: the loop waits for #PALPATE_HOMED before it is armed. Its own homing waits anyway. */
    uint32_t leave_weight;    /**< 0, or 1: no gravity compensation. */
    uint32_t between_counts;  /**< 0, or 1: estimates the position between encoder counts, best with a corner of 80 Hz. */
} palpate_settings;

/** What a texture may look at. */
typedef struct palpate_touched {
    float parameters[2]; /**< (u, v) of the witness point. */
    float point[3];      /**< The witness point, m. */
    float normal[3];     /**< Unit vector out of the body there. */
    float along_u[3];    /**< Unit tangent along u. */
    float velocity[3];   /**< Of the probe, m/s. */
    float push;          /**< Normal force without texture, N. */
} palpate_touched;

/** A texture: writes an extra force on the probe, three components, N. Called in the tick, it must return soon. */
typedef void (*palpate_texture_force)(const palpate_touched *touched, float *force);

/**
 * Takes the program's texture, one for all loops whose palpate_settings::texture_share is not 0: before those start.
 *
 * @param force the function, which stays
 * @return #PALPATE_OK.
 */
palpate_status palpate_texture(palpate_texture_force force);

/** What a motor's winding bears. */
typedef struct palpate_endurance {
    float continuous;    /**< Continuous torque, as a share of full duty, positive; above 1 the amplifier is the limit. */
    float time_constant; /**< Thermal, of the winding, s: 100 to 2,400,000 ticks, at most 600 s. */
} palpate_endurance;

/** What protects motors and hand. Joints that the device does not have are not looked at. */
typedef struct palpate_protection {
    palpate_endurance motors[3]; /**< What each motor bears. */
    float max_joint_rates[3];    /**< Maximum speed of each joint while force is given, rad/s, positive, at most 500. */
    float max_probe_speed;       /**< Maximum speed of the probe while force is given, m/s, positive, at most 10. */
    uint32_t watch_signs;        /**< 0, or 1: polarity check. Until each motor was seen to push the right way the loop
                                      gives no force and no gravity compensation, and in the first contacts after a start
                                      pulses one motor after another, 8 ms, at most a quarter of max_force. A motor that
                                      pushes the wrong way is #PALPATE_FAULT_WRONG_POLARITY. With recorded counts no
                                      joint follows its pulse, and no force comes: 0 there. */
    float inertia[3];            /**< Moment of inertia that turns with each joint, kg·m², positive; for that check, without it finite. */
    uint32_t watch_supply;       /**< 0, or 1: a supply out of range, or not told by palpate_servo_supply(), is a fault. */
    uint32_t least_supply;       /**< Minimum, mV. */
    uint32_t most_supply;        /**< Maximum, mV, above it. */
} palpate_protection;

/** palpate_homing::by. */
enum {
    PALPATE_BY_POSE = 1,  /**< A hand holds the device still in a pose whose joint angles are known. */
    PALPATE_BY_INDEX = 2, /**< Each joint passes its index mark once: palpate_servo_index(). */
    PALPATE_BY_STOPS = 3  /**< The motors drive one joint after the other to its end stop. */
};

/** Where a joint is known. All but the angle is looked at with #PALPATE_BY_STOPS only. */
typedef struct palpate_reference {
    float angle;     /**< The joint's angle there, rad. */
    float speed;     /**< Towards the stop, rad/s; its sign is the way. */
    float torque;    /**< The greatest, N·m: above friction and weight, below what would hurt. */
    float clearance; /**< How far it moves away first, rad: a joint that does not come off is jammed. */
    float travel;    /**< How far the stop may be from there, rad. */
} palpate_reference;

/** How a loop finds out where its joints are. Joints that the device does not have are not looked at. */
typedef struct palpate_homing {
    uint32_t by;                 /**< #PALPATE_BY_POSE, #PALPATE_BY_INDEX or #PALPATE_BY_STOPS. */
    uint32_t still_ticks;        /**< Ticks that the device must hold still, 1 at least ... */
    uint32_t still_counts;       /**< ... within this number of counts of each encoder. */
    uint32_t timeout_ticks;      /**< Ticks after which it is refused, a fault; above still_ticks. */
    uint32_t when_asked;         /**< 0, or 1: it goes on only while force is asked for, as stops always do. */
    palpate_reference joints[3]; /**< Each joint's. */
} palpate_homing;

/** Fills in the defaults: 1 kHz, a soft wall and little force, within what every device that ships takes. @return #PALPATE_OK. */
palpate_status palpate_settings_default(palpate_settings *settings);

/**
 * Fills in what Rust recommends for a device: 4 kHz, at most 500 N/m and 2 N·s/m, position between counts, easing.
 * For a shipped device use device_settings() of its header: two of them are softer.
 *
 * @param settings where they go
 * @param device   the device
 * @return #PALPATE_OK, or what of the device is refused: #PALPATE_DEVICE_ENCODER to #PALPATE_DEVICE_LIMIT.
 */
palpate_status palpate_settings_recommended(palpate_settings *settings, const palpate_device *device);
/** @} */

/** @name The servo loop
 *  @{ */

/** palpate_output::phase. */
enum {
    PALPATE_PHASE_RESET = 0,     /**< Nothing has been sensed yet. */
    PALPATE_PHASE_CALIBRATE = 1, /**< Sensors settle, tables are checked. */
    PALPATE_PHASE_ARMED = 2,     /**< Tracking, motors at zero. */
    PALPATE_PHASE_RUNNING = 3,   /**< Rendering force. */
    PALPATE_PHASE_FAULT = 4      /**< Stopped; only a new start leaves it. */
};

/** Why the chip was reset: the last argument of the functions that start a loop. */
enum {
    PALPATE_RESET_POWER_ON = 0,  /**< Power was switched on. */
    PALPATE_RESET_PIN = 1,       /**< The reset pin, or a debugger. */
    PALPATE_RESET_SOFTWARE = 2,  /**< The program asked for it. */
    PALPATE_RESET_WATCHDOG = 3,  /**< A watchdog: the loop starts with a fault. */
    PALPATE_RESET_BROWN_OUT = 4, /**< The supply broke down: the loop starts with a fault. */
    PALPATE_RESET_UNKNOWN = 5    /**< The board cannot tell. */
};

/** The events of palpate_servo_note(). */
enum {
    PALPATE_LINK_ALIVE = 1,     /**< The host said something. */
    PALPATE_OVERRUN = 2,        /**< A tick took longer than its period. */
    PALPATE_DRIVE_FAULT = 3,    /**< A motor driver reports a fault. */
    PALPATE_HOMED = 4,          /**< Homing of the program's own is done: counts are angles now. */
    PALPATE_HOMING_REFUSED = 5, /**< Homing was refused. */
    PALPATE_STOP = 6,           /**< Stop. */
    PALPATE_ACKNOWLEDGED = 7    /**< Somebody has looked at the device after a reset that is a fault. */
};

/** What the motors get: do as it says, whatever the phase. */
typedef struct palpate_output {
    uint32_t drives;   /**< 0: every stage off; 1: these duties. */
    int32_t duties[3]; /**< Full scale -32767 to 32767. */
    uint32_t phase;    /**< #PALPATE_PHASE_RESET to #PALPATE_PHASE_FAULT. */
    uint32_t fault;    /**< What stopped it, such as #PALPATE_FAULT_JOINT_JUMPED; 0 for nothing. */
} palpate_output;

/** A loop's state after a tick. */
typedef struct palpate_state {
    uint32_t ticks;         /**< Ticks done. */
    uint32_t phase;         /**< #PALPATE_PHASE_RESET to #PALPATE_PHASE_FAULT. */
    uint32_t fault;         /**< What stopped it, such as #PALPATE_FAULT_JOINT_JUMPED; 0 for nothing. */
    uint32_t fault_tick;    /**< At which tick. */
    uint32_t contact;       /**< 0 behind the surface, 1 in front of it, 2 touching. */
    uint32_t feature;       /**< As palpate_touch::feature. */
    uint32_t frames_lost;   /**< Frames lost, late or damaged so far. */
    uint32_t overruns;      /**< Ticks that overran so far. */
    uint32_t contacts_lost; /**< How often contact ended, and the force with it, because no wall holds a hand so deep or no motion
                                 explained it. Too often: #PALPATE_FAULT_CONTACT_LOST. */
    uint32_t rejected_steps;  /**< Rejected steps so far. */
    uint32_t refusal;       /**< Why homing was refused, 0 if it was not; palpate_refusal_text() has it in words. */
    uint32_t too_deep;      /**< As palpate_touch::too_deep, while touching. */
    float probe[3];         /**< In the body's frame, m. */
    float point[3];         /**< The witness point, m. */
    float parameters[2];    /**< Its parameters. */
    float gap;              /**< m; negative inside. */
    float force[3];         /**< On the probe, N, in the device's frame. */
    float angles[3];        /**< Joint angles, rad. */
    float rates[3];         /**< Joint rates, rad/s. */
    float fade;             /**< How far the force is faded in, 0 to 1. */
    float room;             /**< Room to the rim of the workspace, 0 to 1. */
    uint32_t digest;        /**< Hash of every bit of the state: the same on every machine, and in Rust. */
} palpate_state;

/**
 * Starts a loop without protection on a serial arm, which has three joints. The linker drops the loops that a program
 * does not start.
 *
 * @param servo       memory for the loop
 * @param servo_bytes `sizeof` it
 * @param mechanism   the mechanism
 * @param device      the device's numbers; as many joints are read as the mechanism has
 * @param body        the body to render; it must outlive the loop
 * @param settings    the settings
 * @param reset       why the chip was reset: #PALPATE_RESET_POWER_ON to #PALPATE_RESET_UNKNOWN
 * @return #PALPATE_OK; else there is no loop, its handle is #PALPATE_NOT_READY, and nothing drives. Every function that starts a
 *         loop: #PALPATE_TOO_SMALL of servo_bytes, #PALPATE_NOT_READY of the body, #PALPATE_NOT_FINITE of a number,
 *         #PALPATE_OUT_OF_RANGE of reset or of a field that is 0 or 1, #PALPATE_DEVICE_ENCODER to
 *         #PALPATE_DEVICE_WEIGHT, #PALPATE_SETTINGS_RATE to #PALPATE_SETTINGS_EASE; with protection
 *         #PALPATE_PROTECTION_CONTINUOUS to #PALPATE_PROTECTION_INERTIA; of a dial the PALPATE_KNOB_ values.
 */
palpate_status palpate_servo_start_serial_arm(palpate_servo *servo, size_t servo_bytes,
                                              const palpate_serial_arm *mechanism, const palpate_device *device,
                                              const palpate_body *body, const palpate_settings *settings,
                                              uint32_t reset);
/** The same on a delta, which has three joints. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_delta(palpate_servo *servo, size_t servo_bytes, const palpate_delta *mechanism,
                                         const palpate_device *device, const palpate_body *body,
                                         const palpate_settings *settings, uint32_t reset);
/** The same on a linkage arm, which has three joints. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_linkage_arm(palpate_servo *servo, size_t servo_bytes,
                                               const palpate_linkage_arm *mechanism, const palpate_device *device,
                                               const palpate_body *body, const palpate_settings *settings,
                                               uint32_t reset);
/** The same on a five-bar, which has two joints. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_five_bar(palpate_servo *servo, size_t servo_bytes,
                                            const palpate_five_bar *mechanism, const palpate_device *device,
                                            const palpate_body *body, const palpate_settings *settings,
                                            uint32_t reset);
/** The same on a paddle, which has one joint. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_paddle(palpate_servo *servo, size_t servo_bytes, const palpate_paddle *mechanism,
                                          const palpate_device *device, const palpate_body *body,
                                          const palpate_settings *settings, uint32_t reset);

/**
 * Starts a loop with protection on a serial arm. It is larger and slower than a loop without.
 *
 * @param servo       memory for the loop
 * @param servo_bytes `sizeof` it
 * @param mechanism   the mechanism
 * @param device      the device's numbers; as many joints are read as the mechanism has
 * @param body        the body to render; it must outlive the loop
 * @param settings    the settings
 * @param protection  the limits of motors and joints, for as many joints
 * @param reset       why the chip was reset: #PALPATE_RESET_POWER_ON to #PALPATE_RESET_UNKNOWN
 * @return as all functions that start a loop: see palpate_servo_start_serial_arm().
 */
palpate_status palpate_servo_start_serial_arm_protected(palpate_servo *servo, size_t servo_bytes,
                                                        const palpate_serial_arm *mechanism,
                                                        const palpate_device *device, const palpate_body *body,
                                                        const palpate_settings *settings,
                                                        const palpate_protection *protection, uint32_t reset);
/** The same on a delta, which has three joints. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_delta_protected(palpate_servo *servo, size_t servo_bytes,
                                                   const palpate_delta *mechanism, const palpate_device *device,
                                                   const palpate_body *body, const palpate_settings *settings,
                                                   const palpate_protection *protection, uint32_t reset);
/** The same on a linkage arm, which has three joints. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_linkage_arm_protected(palpate_servo *servo, size_t servo_bytes,
                                                         const palpate_linkage_arm *mechanism,
                                                         const palpate_device *device, const palpate_body *body,
                                                         const palpate_settings *settings,
                                                         const palpate_protection *protection, uint32_t reset);
/** The same on a five-bar, which has two joints. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_five_bar_protected(palpate_servo *servo, size_t servo_bytes,
                                                      const palpate_five_bar *mechanism, const palpate_device *device,
                                                      const palpate_body *body, const palpate_settings *settings,
                                                      const palpate_protection *protection, uint32_t reset);
/** The same on a paddle, which has one joint. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_paddle_protected(palpate_servo *servo, size_t servo_bytes,
                                                    const palpate_paddle *mechanism, const palpate_device *device,
                                                    const palpate_body *body, const palpate_settings *settings,
                                                    const palpate_protection *protection, uint32_t reset);

/** Starts a loop without protection on a serial arm, with a body that gives way. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_serial_arm_soft(palpate_servo *servo, size_t servo_bytes,
                                                   const palpate_serial_arm *mechanism, const palpate_device *device,
                                                   const palpate_soft_body *body, const palpate_settings *settings,
                                                   uint32_t reset);
/** The same on a delta. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_delta_soft(palpate_servo *servo, size_t servo_bytes, const palpate_delta *mechanism,
                                              const palpate_device *device, const palpate_soft_body *body,
                                              const palpate_settings *settings, uint32_t reset);
/** The same on a linkage arm. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_linkage_arm_soft(palpate_servo *servo, size_t servo_bytes,
                                                    const palpate_linkage_arm *mechanism, const palpate_device *device,
                                                    const palpate_soft_body *body, const palpate_settings *settings,
                                                    uint32_t reset);
/** The same on a five-bar. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_five_bar_soft(palpate_servo *servo, size_t servo_bytes,
                                                 const palpate_five_bar *mechanism, const palpate_device *device,
                                                 const palpate_soft_body *body, const palpate_settings *settings,
                                                 uint32_t reset);
/** The same on a paddle. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_paddle_soft(palpate_servo *servo, size_t servo_bytes,
                                               const palpate_paddle *mechanism, const palpate_device *device,
                                               const palpate_soft_body *body, const palpate_settings *settings,
                                               uint32_t reset);
/** Starts a loop with protection on a serial arm, with a body that gives way. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_serial_arm_soft_protected(palpate_servo *servo, size_t servo_bytes,
                                                             const palpate_serial_arm *mechanism,
                                                             const palpate_device *device,
                                                             const palpate_soft_body *body,
                                                             const palpate_settings *settings,
                                                             const palpate_protection *protection, uint32_t reset);
/** The same on a delta. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_delta_soft_protected(palpate_servo *servo, size_t servo_bytes,
                                                        const palpate_delta *mechanism, const palpate_device *device,
                                                        const palpate_soft_body *body, const palpate_settings *settings,
                                                        const palpate_protection *protection, uint32_t reset);
/** The same on a linkage arm. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_linkage_arm_soft_protected(palpate_servo *servo, size_t servo_bytes,
                                                              const palpate_linkage_arm *mechanism,
                                                              const palpate_device *device,
                                                              const palpate_soft_body *body,
                                                              const palpate_settings *settings,
                                                              const palpate_protection *protection, uint32_t reset);
/** The same on a five-bar. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_five_bar_soft_protected(palpate_servo *servo, size_t servo_bytes,
                                                           const palpate_five_bar *mechanism,
                                                           const palpate_device *device, const palpate_soft_body *body,
                                                           const palpate_settings *settings,
                                                           const palpate_protection *protection, uint32_t reset);
/** The same on a paddle. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_paddle_soft_protected(palpate_servo *servo, size_t servo_bytes,
                                                         const palpate_paddle *mechanism, const palpate_device *device,
                                                         const palpate_soft_body *body,
                                                         const palpate_settings *settings,
                                                         const palpate_protection *protection, uint32_t reset);

/**
 * Starts a loop without protection on a serial arm, with a tool that has a shape. Tell the orientation of its handle before
 * every tick, or at least every 20 ms. There is no force before the first, nor until all contacts are located
 * (palpate_held::located), nor while a tool that went into the body before is in it: keep it outside until then. The force
 * is the wall's on the tool: palpate_state::gap and palpate_state::point are the tool's. There is no torque: turned in
 * contact, the force alone does not conserve energy.
 *
 * A tick takes 5,000 to 25,000 instructions of a Cortex-M4F on a box, more on other bodies: `palpate budgets --tool MODEL`.
 * The start takes less than 20 KB of stack there, a tick less than 10 KB.
 *
 * @param servo       palpate_tool_servo::servo, memory for the loop
 * @param servo_bytes `sizeof` the ::palpate_tool_servo
 * @param mechanism   the mechanism
 * @param device      the device's numbers
 * @param body        the body to render; it must outlive the loop
 * @param tool        the tool
 * @param settings    the settings, without friction, texture and virtual tool, which are a point's
 * @param reset       why the chip was reset: #PALPATE_RESET_POWER_ON to #PALPATE_RESET_UNKNOWN
 * @return as palpate_servo_start_serial_arm(), or #PALPATE_TOOL_MEMORY to #PALPATE_TOOL_COUPLING.
 */
palpate_status palpate_servo_start_serial_arm_tool(palpate_servo *servo, size_t servo_bytes,
                                                   const palpate_serial_arm *mechanism, const palpate_device *device,
                                                   const palpate_body *body, const palpate_tool *tool,
                                                   const palpate_settings *settings, uint32_t reset);
/** The same on a serial arm, with protection. @return as palpate_servo_start_serial_arm_tool(). */
palpate_status palpate_servo_start_serial_arm_tool_protected(palpate_servo *servo, size_t servo_bytes,
                                                             const palpate_serial_arm *mechanism,
                                                             const palpate_device *device, const palpate_body *body,
                                                             const palpate_tool *tool, const palpate_settings *settings,
                                                             const palpate_protection *protection, uint32_t reset);
/** The same on a delta. @return as palpate_servo_start_serial_arm_tool(). */
palpate_status palpate_servo_start_delta_tool(palpate_servo *servo, size_t servo_bytes, const palpate_delta *mechanism,
                                              const palpate_device *device, const palpate_body *body,
                                              const palpate_tool *tool, const palpate_settings *settings,
                                              uint32_t reset);
/** The same on a delta, with protection. @return as palpate_servo_start_serial_arm_tool(). */
palpate_status palpate_servo_start_delta_tool_protected(palpate_servo *servo, size_t servo_bytes,
                                                        const palpate_delta *mechanism, const palpate_device *device,
                                                        const palpate_body *body, const palpate_tool *tool,
                                                        const palpate_settings *settings,
                                                        const palpate_protection *protection, uint32_t reset);
/** The same on a linkage arm. @return as palpate_servo_start_serial_arm_tool(). */
palpate_status palpate_servo_start_linkage_arm_tool(palpate_servo *servo, size_t servo_bytes,
                                                    const palpate_linkage_arm *mechanism, const palpate_device *device,
                                                    const palpate_body *body, const palpate_tool *tool,
                                                    const palpate_settings *settings, uint32_t reset);
/** The same on a linkage arm, with protection. @return as palpate_servo_start_serial_arm_tool(). */
palpate_status palpate_servo_start_linkage_arm_tool_protected(palpate_servo *servo, size_t servo_bytes,
                                                              const palpate_linkage_arm *mechanism,
                                                              const palpate_device *device, const palpate_body *body,
                                                              const palpate_tool *tool,
                                                              const palpate_settings *settings,
                                                              const palpate_protection *protection, uint32_t reset);

/**
 * Tells the orientation of the handle between two ticks: of an inertial sensor, or of a plate that never turns. One
 * older than 20 ms ends contact, as does one that is 40 rad/s from the one before. A refused one is not noted.
 *
 * @param servo      the loop
 * @param quaternion x, y, z, w of length 1: takes the tool's frame to the device's
 * @return #PALPATE_OK, #PALPATE_NOT_FINITE, #PALPATE_TOOL_NONE, or #PALPATE_TOOL_ROTATION.
 */
palpate_status palpate_servo_orient(palpate_servo *servo, const float *quaternion);

/**
 * The same from the counts of a wrist on the arm's last link, before each tick.
 *
 * @param servo  the loop
 * @param wrist  the wrist, or NULL: the handle is rigid on the last link or plate, and counts are not looked at
 * @param arm    three encoder counts of the arm, those of the tick
 * @param counts three of the wrist; farther from the last good ones than max_rate allows in a tick is a jump. NULL if none
 *               came, or calls were missed: nothing is noted, and the next are not compared
 * @return #PALPATE_OK, #PALPATE_TOOL_NONE, or #PALPATE_WRIST_NUMBERS to #PALPATE_WRIST_JUMP.
 */
palpate_status palpate_servo_orient_wrist(palpate_servo *servo, const palpate_wrist *wrist, const int32_t *arm,
                                          const int32_t *counts);

/**
 * The contacts of the tool after the last tick.
 *
 * @param servo the loop
 * @param held  where they go
 * @return #PALPATE_OK, or #PALPATE_TOOL_NONE.
 */
palpate_status palpate_servo_held(palpate_servo *servo, palpate_held *held);

/**
 * Starts a loop without protection on a dial: the force is the feel's, and there is no body. Stiffness and damping of
 * the settings do nothing. Where force starts, the feel moves to the dial: see palpate_servo_feel().
 *
 * @param servo       memory for the loop
 * @param servo_bytes `sizeof` it
 * @param dial        the dial
 * @param device      the device's numbers; of a dial that turns without end the range is -INFINITY to INFINITY
 * @param feel        the feel to start with
 * @param settings    the settings
 * @param reset       why the chip was reset: #PALPATE_RESET_POWER_ON to #PALPATE_RESET_UNKNOWN
 * @return as all functions that start a loop: see palpate_servo_start_serial_arm().
 */
palpate_status palpate_servo_start_dial(palpate_servo *servo, size_t servo_bytes, const palpate_dial *dial,
                                        const palpate_device *device, const palpate_feel *feel,
                                        const palpate_settings *settings, uint32_t reset);
/** The same with protection. @return as palpate_servo_start_serial_arm(). */
palpate_status palpate_servo_start_dial_protected(palpate_servo *servo, size_t servo_bytes, const palpate_dial *dial,
                                                  const palpate_device *device, const palpate_feel *feel,
                                                  const palpate_settings *settings,
                                                  const palpate_protection *protection, uint32_t reset);

/**
 * Sets one part of a dial's feel between two ticks, with the tick's interrupt masked; the other parts stay. The torque
 * does not step: the difference decays at palpate_dial::release_rate. A refused part changes nothing; a part that would
 * take the dial further than an eighth of a turn is refused.
 *
 * @param servo the loop
 * @param part  which, such as #PALPATE_FEEL_DETENTS
 * @param feel  holds the part; nothing else of it is looked at
 * @param beyond the number that was refused, or NULL; written on a refusal of the part only
 * @return #PALPATE_OK, #PALPATE_OUT_OF_RANGE of the part, #PALPATE_KNOB_NONE to #PALPATE_KNOB_UNDAMPED, or #PALPATE_KNOB_MOTOR.
 */
palpate_status palpate_servo_set_feel(palpate_servo *servo, uint32_t part, const palpate_feel *feel,
                                      palpate_beyond *beyond);

/**
 * The feel that is set now. Where force starts, the spring rests where the dial is, end stops and range of clicks move until
 * the dial is between them, and the notch moves to its turn.
 *
 * @param servo the loop
 * @param feel  where it goes
 * @return #PALPATE_OK, or #PALPATE_KNOB_NONE.
 */
palpate_status palpate_servo_feel(palpate_servo *servo, palpate_feel *feel);

/**
 * The dial after the last tick.
 *
 * @param servo the loop
 * @param dial  where it goes
 * @return #PALPATE_OK, or #PALPATE_KNOB_NONE.
 */
palpate_status palpate_servo_dial(palpate_servo *servo, palpate_turned *dial);

/**
 * One tick, from encoder counts to duties. The output is off unless the call comes back with #PALPATE_OK.
 *
 * @param servo  the loop
 * @param counts encoder counts, one a joint, signed and unwrapped (not 16 bits of a timer), within 2^24 of 0; a jump
 *               above max_joint_rate / rate, or an angle out of range, is a fault
 * @param joints how many: as many as the mechanism has
 * @param enable not 0: force is asked for
 * @param output where what the motors get goes
 * @return #PALPATE_OK, also with a fault (palpate_output::fault); #PALPATE_OUT_OF_RANGE of joints: nothing has ticked.
 */
palpate_status palpate_servo_tick(palpate_servo *servo, const int32_t *counts, size_t joints, uint32_t enable,
                                  palpate_output *output);

/**
 * One tick without sensors: a fault.
 *
 * @param servo   the loop
 * @param damaged 0: no frame came, or one of another tick; else one that is damaged
 * @param output  where what the motors get goes
 * @return #PALPATE_OK.
 */
palpate_status palpate_servo_tick_without(palpate_servo *servo, uint32_t damaged, palpate_output *output);

/**
 * Takes note of what happened outside a tick, at any time between two ticks.
 *
 * @param servo  the loop
 * @param event  what happened: #PALPATE_LINK_ALIVE to #PALPATE_ACKNOWLEDGED
 * @param output where what the motors now get goes
 * @return #PALPATE_OK, or #PALPATE_OUT_OF_RANGE of the event.
 */
palpate_status palpate_servo_note(palpate_servo *servo, uint32_t event, palpate_output *output);

/**
 * Tells what the motors' supply was measured at, between two ticks. A loop that does not watch it takes no notice.
 *
 * @param servo      the loop
 * @param millivolts mV
 * @param output     where what the motors now get goes
 * @return #PALPATE_OK.
 */
palpate_status palpate_servo_supply(palpate_servo *servo, uint32_t millivolts, palpate_output *output);

/**
 * Has a loop find out where its joints are, between its start and its first tick: until that is done no angle is
 * believed, and #PALPATE_HOMED is not listened to. Where the motors drive the joints, palpate_output says so.
 *
 * @param servo  the loop
 * @param homing how
 * @return #PALPATE_OK, #PALPATE_OUT_OF_RANGE of by or when_asked, or #PALPATE_HOMING_ANGLE to #PALPATE_HOMING_STARTED.
 */
palpate_status palpate_servo_home(palpate_servo *servo, const palpate_homing *homing);

/**
 * Tells that a joint passed its index mark, between two ticks. A loop that homes in another way takes no notice.
 *
 * @param servo  the loop
 * @param joint  which, from 0
 * @param counts the count that was caught there
 * @param output where what the motors now get goes
 * @return #PALPATE_OK, or #PALPATE_OUT_OF_RANGE of the joint.
 */
palpate_status palpate_servo_index(palpate_servo *servo, uint32_t joint, int32_t counts, palpate_output *output);

/**
 * The state after the last tick.
 *
 * @param servo the loop
 * @param state where it goes
 * @return #PALPATE_OK.
 */
palpate_status palpate_servo_state(palpate_servo *servo, palpate_state *state);

/**
 * How far each mode of a body that gives way is after the last tick.
 *
 * @param servo the loop
 * @param q     where they go, #PALPATE_MAX_MODES numbers, m; those of modes that the body has not are 0
 * @return #PALPATE_OK, or #PALPATE_SOFT_NONE.
 */
palpate_status palpate_servo_modes(palpate_servo *servo, float *q);
/** @} */

/** @name The wire
 *  Frames in lockstep with a simulated device, as `palpate demo` speaks them.
 *  @{ */

/** Bytes that hold any frame. */
#define PALPATE_MAX_FRAME 128

/** What a byte has completed. */
typedef struct palpate_heard {
    uint32_t what;     /**< 0 nothing, 1 sensors, 2 a damaged frame, 3 an empty one. */
    uint32_t tick;     /**< Which tick the sensors are for. */
    int32_t counts[3]; /**< Encoder counts. */
    uint32_t enable;   /**< 1 if force is asked for. */
} palpate_heard;

/**
 * Makes a receiver at the start of a frame.
 *
 * @param receiver       where it goes
 * @param receiver_bytes `sizeof` it
 * @return #PALPATE_OK.
 */
palpate_status palpate_receiver_start(palpate_receiver *receiver, size_t receiver_bytes);

/**
 * Takes the next byte.
 *
 * @param receiver the receiver
 * @param byte     the byte
 * @param heard    where what it completed goes
 * @return #PALPATE_OK.
 */
palpate_status palpate_receiver_feed(palpate_receiver *receiver, uint8_t byte, palpate_heard *heard);

/**
 * Packs the report of the last tick into a frame.
 *
 * @param servo        the loop
 * @param instructions what the board counted for the tick, 0 where it cannot
 * @param frame        where the frame goes
 * @param frame_bytes  how much there is; #PALPATE_MAX_FRAME holds any
 * @param written      where the frame's length goes
 * @return #PALPATE_OK, or #PALPATE_TOO_SMALL of the frame.
 */
palpate_status palpate_servo_report(palpate_servo *servo, uint32_t instructions, uint8_t *frame, size_t frame_bytes,
                                    size_t *written);
/** @} */

#ifdef __cplusplus
}
#endif

#endif
