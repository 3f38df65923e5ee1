"""Messages for tests: transforms of given numbers, and the matrices that they stand for."""

import numpy as np
from geometry_msgs.msg import TransformStamped
from hypothesis import strategies as st

coordinates = st.floats(-100.0, 100.0)
quaternions = (
    st.tuples(*[st.floats(-1.0, 1.0)] * 4)
    .filter(lambda numbers: np.linalg.norm(numbers) > 0.1)
    .map(lambda numbers: tuple(float(number) for number in np.array(numbers) / np.linalg.norm(numbers)))
)
poses = st.tuples(st.tuples(*[coordinates] * 3), quaternions)


def stamped(parent, child, seconds=0.0, place=(0.0, 0.0, 0.0), turn=(0.0, 0.0, 0.0, 1.0)):
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    message.header.stamp.sec, message.header.stamp.nanosec = divmod(round(seconds * 1e9), 10**9)
    translation, rotation = message.transform.translation, message.transform.rotation
    translation.x, translation.y, translation.z = map(float, place)
    rotation.x, rotation.y, rotation.z, rotation.w = map(float, turn)
    return message


def matrix(place, turn):
    """Return the homogeneous matrix of a pose, written out from the definition of the product q v q*."""
    x, y, z, w = turn
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    done = np.identity(4)
    done[:3, :3] += 2.0 * w * cross + 2.0 * cross @ cross
    done[:3, 3] = place
    return done


def matrix_of(message):
    translation, rotation = message.transform.translation, message.transform.rotation
    return matrix((translation.x, translation.y, translation.z), (rotation.x, rotation.y, rotation.z, rotation.w))
