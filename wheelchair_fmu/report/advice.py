"""What a person with a chair before them can look at for each effect of the catalogue."""

from __future__ import annotations

INSPECT = {
    "accelerometer_bias": "Let the chair stand level for ten seconds and see what the accelerometer reads: it should be zero.",
    "accelerometer_offset": "Measure with a tape how far the accelerometer sits from the centre of mass, forward and sideways.",
    "accelerometer_tilt": "Check with a spirit level that the accelerometer sits level and square on the frame.",
    "aerodynamic_drag": "Look for wind, a fan or loose clothing, and coast down once in each direction of the hall.",
    "camber_misalignment": "Measure the lean of both rear wheels: the gap between rims at the top less that at the bottom.",
    "caster_friction": "Lift the front and swing each caster by hand: it should turn freely. Clean and loosen its bearing.",
    "caster_inertia": "Weigh a caster with its fork, and see how far its mass lies from the pivot.",
    "caster_trail": "Measure from the caster's pivot back to where its wheel touches the floor.",
    "cm_lateral_offset": "Weigh the chair with the rider on two scales, one under each rear wheel: they should read the same.",
    "floor_cross_slope": "Lay a long spirit level across the floor where the runs were made.",
    "floor_slope": "Lay a long spirit level on the floor along two directions of the room.",
    "gyro_bias": "Let the chair stand for ten seconds and see what the yaw rate sensor reads: it should be zero.",
    "gyro_scale": "Turn the chair by hand through ten full turns and compare what the yaw rate sensor adds up to.",
    "inflation_pressure": "Measure the pressure of both rear tyres with a gauge.",
    "lateral_load_transfer": "Estimate the height of the centre of mass, by weighing the chair level and tilted to a side.",
    "load_sensitivity": "Have the tyre measured at two loads, or repeat a slalom with a weight on the seat.",
    "longitudinal_load_transfer": "Estimate the height of the centre of mass, by weighing the chair level and tilted back.",
    "longitudinal_slip": "Look for a slippery floor or worn tread, and compare a wheel's turns with the way it rolled.",
    "marker_offset": "Measure with a tape how far the marker lies from the centre of mass.",
    "pivot_torque": "Turn the chair about one wheel that stands, by the other rim, and feel what lets go once it rolls.",
    "pneumatic_trail_decay": "Repeat the tightest turn: this shows at large slip only, so see how the tyre was identified.",
    "push_force_delay": "Tap the push rim sharply and compare when the force and the accelerometer show it.",
    "push_force_gain": "Hang a known weight on each push rim and compare what its force sensor reads.",
    "relaxation_length": "Compare the tyres with those that were identified: a soft or wide tyre follows slip more slowly.",
    "rolling_resistance_asymmetry": "Lift the rear and spin both wheels. If one stops sooner, look "
    "there for a rubbing brake or a tight bearing; if both turn alike, compare the pressure of their tyres.",
    "rolling_resistance_speed": "Spin the rear wheels off the floor and watch how they slow: grease and seals resist speed.",
    "scrub_torque": "Turn the chair on the spot and feel what it takes to keep it turning; then at a higher tyre pressure.",
    "scrub_torque_viscous": "Turn the chair on the spot slowly and quickly: does turning faster take more?",
    "stroke_motion": "Film the rider over several strokes: does the trunk go to and fro with each, also before the push?",
    "toe_misalignment": "Measure between the rims at hub height, in front and behind: the two should agree.",
    "trunk_motion": "Film the rider from the side and see how far the trunk goes forward with a push.",
    "turn_slip": "Turn the chair on the spot on this floor and on a smoother one, and compare what it takes.",
    "tyre_saturation": "Look at how large the slip became in the tightest turn, and at the friction of floor and tyre.",
    "wheel_inertia": "Weigh a rear wheel with its rim: a heavy one takes a share of every push.",
    "wheel_radius_error": "Roll the chair straight over ten metres and compare with what each wheel's sensor counted.",
}


def inspect(effect: str, title: str) -> str:
    """What to look at for an effect; of one that a user wrote, only its title is known."""
    return INSPECT.get(effect, f"Look at the chair for {title}.")


# by how the id of a generic term begins, the more special first
TERMS = {
    "generic_M_w_one_sided": "Lift the front and let each caster hang: feel whether something turns it to one side.",
    "generic_M_w": "Swing each caster by hand, on the floor and lifted: feel whether something pulls it straight.",
    "generic_D_r": "Lift the rear and spin that wheel slowly and fast, both ways: look and listen for what holds it.",
    "generic_F_x": "Coast down from a quick start, once in each direction: look for what rubs, and for wind.",
    "generic_F_y": "Let the chair roll freely: see whether it drifts to a side, on this floor and in the other direction.",
    "generic_M_z": "Turn the chair on the spot and in wide curves, to both sides: feel what turns it or holds it back.",
    "generic_read_yaw_rate": "Let the chair stand, then turn it by hand ten times, and compare what the yaw rate adds up to.",
    "generic_read_a": "Let the chair stand level, then tilted by a known angle, and see what the accelerometer reads.",
}


def inspect_term(term: str) -> str:
    """What to look at for a generic term."""
    return next(words for begins, words in TERMS.items() if term.startswith(begins))
