//! Which joint is on which of the board's inputs and outputs.

/// Which of the board's encoder inputs and motor outputs each joint is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wiring<const JOINTS: usize> {
    inputs: [u8; JOINTS],
    outputs: [u8; JOINTS],
}

impl<const JOINTS: usize> Wiring<JOINTS> {
    /// Each joint on the input and the output of its number.
    pub const STRAIGHT: Self = {
        let mut channels = [0; JOINTS];
        let mut joint = 0;
        while joint < JOINTS {
            channels[joint] = joint as u8;
            joint += 1;
        }
        Self { inputs: channels, outputs: channels }
    };

    /// A wiring: for each joint, its input and its output. `None` unless each joint has one of its own.
    pub const fn try_new(inputs: [u8; JOINTS], outputs: [u8; JOINTS]) -> Option<Self> {
        if is_each_once(&inputs) && is_each_once(&outputs) { Some(Self { inputs, outputs }) } else { None }
    }

    /// Reorders values from the inputs' order to the joints' order.
    #[inline]
    pub fn joints<T: Copy>(&self, at_inputs: [T; JOINTS]) -> [T; JOINTS] {
        let mut joints = at_inputs;
        for (joint, input) in joints.iter_mut().zip(self.inputs) {
            // Always there.
            if let Some(found) = at_inputs.get(usize::from(input)) {
                *joint = *found;
            }
        }
        joints
    }

    /// Reorders values from the joints' order to the inputs' order.
    #[inline]
    pub fn inputs<T: Copy>(&self, at_joints: [T; JOINTS]) -> [T; JOINTS] {
        spread(self.inputs, at_joints)
    }

    /// Reorders values from the joints' order to the outputs' order.
    #[inline]
    pub fn outputs<T: Copy>(&self, at_joints: [T; JOINTS]) -> [T; JOINTS] {
        spread(self.outputs, at_joints)
    }
}

const fn is_each_once<const JOINTS: usize>(channels: &[u8; JOINTS]) -> bool {
    let mut joint = 0;
    while joint < JOINTS {
        let mut times = 0;
        let mut other = 0;
        while other < JOINTS {
            times += (channels[other] as usize == joint) as usize;
            other += 1;
        }
        if times != 1 {
            return false;
        }
        joint += 1;
    }
    true
}

#[inline]
fn spread<T: Copy, const JOINTS: usize>(channels: [u8; JOINTS], at_joints: [T; JOINTS]) -> [T; JOINTS] {
    let mut spread = at_joints;
    for (at_joint, channel) in at_joints.into_iter().zip(channels) {
        // Always there.
        if let Some(place) = spread.get_mut(usize::from(channel)) {
            *place = at_joint;
        }
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_find_their_inputs_and_outputs() {
        let wiring = Wiring::try_new([2, 0, 1], [1, 2, 0]).unwrap();
        assert_eq!(wiring.joints(['x', 'y', 'z']), ['z', 'x', 'y']);
        assert_eq!(wiring.inputs(wiring.joints([7, 8, 9])), [7, 8, 9]);
        assert_eq!(wiring.outputs(['a', 'b', 'c']), ['c', 'a', 'b']);
        assert_eq!(Wiring::STRAIGHT.joints([1, 2, 3]), [1, 2, 3]);
        assert_eq!(Wiring::STRAIGHT.outputs([1, 2, 3]), [1, 2, 3]);
        for wrong in [[0, 0, 1], [0, 1, 3], [1, 2, 255]] {
            assert_eq!(Wiring::try_new(wrong, [0, 1, 2]), None);
            assert_eq!(Wiring::try_new([0, 1, 2], wrong), None);
        }
    }
}
